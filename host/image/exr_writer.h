#pragma once
/// The EXR half of PictureWriter: scan lines through OpenEXR into a temporary file.
#include "host/image/picture_writer.h"
#include <memory>
#include <string>
#include <vector>

namespace pointgi {

/// Bands must fit (PictureWriter checks them). All functions throw Error(output).
class ExrWriter {
public:
  ExrWriter(const std::string& path, int full_width, int full_height, PixelWindow window,
            std::vector<ChannelName> channels, const PictureAttributes& attributes);
  ~ExrWriter();
  ExrWriter(const ExrWriter&) = delete;
  ExrWriter& operator=(const ExrWriter&) = delete;

  void write(const Band& band);
  void write_zeros(int rows);

  /// All rows are there: completes the header and the line table. The file still has its temporary name.
  void close(double render_seconds);
  /// After close(): fsync and rename.
  void commit();

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pointgi
