#pragma once
/// The files of a picture, which may be written again and again as it gets better.
#include "host/api/parts.h"
#include "host/image/picture_writer.h"

namespace pointgi {

class PictureOutput {
public:
  /// `exr`: OUT.exr, beside which OUT.png will be; no `exposure` [stops]: chosen from each picture.
  PictureOutput(std::string exr, std::optional<double> exposure);

  /// A picture's rows from the top, in one go: begin, take, finish. finish() replaces the files of the picture before,
  /// whole or not at all. `seconds`: renderTimeSeconds. Throw Error(output).
  void begin(const api::FilmJob& job);
  void take(const Band& band);
  void finish(double seconds);

  /// All three, of a film that has its rows.
  void write(const api::FilmJob& job, const GrowingFilm& film, double seconds);

  /// Of the picture written last; before it nothing has a value.
  const PngLight& png_light() const { return shown_; }
  const std::string& exr_path() const { return exr_; }
  const std::string& png_path() const { return png_; }
  bool written() const { return written_; }
  double seconds_to_write() const { return seconds_to_write_; } ///< that the last writing took; 0 before it

private:
  std::string exr_, png_;
  std::optional<double> exposure_;
  PngLight shown_;
  std::unique_ptr<PictureWriter> writer_; ///< of the picture that has begun
  bool written_ = false;
  double seconds_to_write_ = 0.0;
};

} // namespace pointgi
