#pragma once
/// The files of a picture, which may be written again and again as it gets better.
#include "host/api/parts.h"
#include "host/denoise/denoise_picture.h"
#include "host/image/picture_writer.h"
#include <memory>

namespace pointgi {

/// What denoising was done.
struct DenoisedPictures {
  std::string file, version;    ///< of the library
  double seconds = 0.0;         ///< of all pictures that were written
  std::optional<Error> failure; ///< of the library, whereupon pictures were written as they were rendered
};

class PictureOutput {
public:
  /// `exr`: OUT.exr, beside which OUT.png will be; no `exposure` [stops]: chosen from each picture. With a `denoiser`
  /// pictures are denoised before they are written; their jobs have auxiliary channels.
  PictureOutput(std::string exr, std::optional<double> exposure, std::unique_ptr<Denoiser> denoiser = nullptr);

  bool denoises() const { return denoiser_ != nullptr; }

  /// A picture's rows from the top, in one go: begin, take, finish. finish() replaces the files of the picture before,
  /// whole or not at all. `seconds`: renderTimeSeconds. Throw Error(output).
  void begin(const api::FilmJob& job);
  void take(const Band& band);
  void finish(double seconds);

  /// Between the last take() and finish(), which does it where this was not called. `progress`: share done, 0..1. Where
  /// the library fails, this and all later pictures are written as they were rendered, and denoised() has the failure.
  void denoise(const std::function<void(double)>& progress);

  /// All three, of a film that has its rows.
  void write(const api::FilmJob& job, const GrowingFilm& film, double seconds);

  /// Of the picture written last; before it nothing has a value.
  const PngLight& png_light() const { return shown_; }
  const std::string& exr_path() const { return exr_; }
  const std::string& png_path() const { return png_; }
  bool written() const { return written_; }
  double seconds_to_write() const { return seconds_to_write_; } ///< that the last writing took; 0 before it

  /// Absent: pictures are not denoised.
  const std::optional<DenoisedPictures>& denoised() const { return denoised_; }

private:
  std::string exr_, png_;
  std::optional<double> exposure_;
  PngLight shown_;
  std::unique_ptr<PictureWriter> writer_; ///< of the picture that has begun
  bool written_ = false;
  double seconds_to_write_ = 0.0;
  std::unique_ptr<Denoiser> denoiser_;
  std::optional<DenoisedPictures> denoised_;
  std::vector<ChannelName> channels_; ///< of the picture that has begun, as are its rows that are to be denoised
  std::optional<Band> rows_;
};

} // namespace pointgi
