#pragma once
/// The EXR half of PictureWriter: scan lines through OpenEXR into a temporary file.
#include "host/image/picture_writer.h"
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pointgi {

/// The stops that were chosen for the PNG: a float attribute of pictures whose exposure is.
inline constexpr char exposure_attribute[] = "pointgi/exposure";

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

  /// All rows are there: completes the header and the line table. The file still has its temporary name. `exposure`:
  /// of the attribute exposure_attribute, where there is one.
  void close(double render_seconds, double exposure = 0.0);
  /// Between close() and commit(): hands over the rows from the top, the named float channels of a row one after the
  /// other.
  void read_rows(const std::vector<std::string>& channels, const std::function<void(const float* row)>& take) const;
  /// After close(): fsync and rename.
  void commit();

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pointgi
