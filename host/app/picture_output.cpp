#include "host/app/picture_output.h"
#include "octree/clock.h"
#include <new>

namespace pointgi {

PictureOutput::PictureOutput(std::string exr, std::optional<double> exposure, std::unique_ptr<Denoiser> denoiser)
    : exr_(std::move(exr)), png_(png_path_of(exr_)), exposure_(exposure), denoiser_(std::move(denoiser)) {
  if (denoises()) denoised_ = DenoisedPictures{denoiser_->file(), denoiser_->version(), 0.0, {}};
}

void PictureOutput::begin(const api::FilmJob& job) {
  writer_.reset(); // removes its temporary files
  const PixelWindow& window = job.window();
  channels_ = job.channels();
  PictureAttributes attributes = job.attributes();
  rows_.reset();
  if (denoises()) {
    channels_.insert(channels_.end(), noisy_channels().begin(), noisy_channels().end());
    attributes.text["pointgi/denoiser"] = "Open Image Denoise " + denoiser_->version();
    rows_ = Band{window.y0, 0, window.x1 - window.x0, std::vector<std::vector<float>>(channels_.size())};
    for (std::vector<float>& channel : rows_->values)
      channel.reserve(static_cast<std::size_t>(rows_->width) * static_cast<std::size_t>(window.y1 - window.y0));
  }
  writer_ = std::make_unique<PictureWriter>(exr_, job.settings().width, job.settings().height, window, channels_,
                                            attributes, exposure_);
}

void PictureOutput::take(const Band& band) {
  if (!rows_) return writer_->write(band);
  for (std::size_t c = 0; c < band.values.size(); ++c)
    rows_->values[c].insert(rows_->values[c].end(), band.values[c].begin(), band.values[c].end());
  rows_->rows += band.rows;
}

void PictureOutput::denoise(const std::function<void(double)>& progress) {
  if (!rows_) return;
  const Clock::time_point begun = Clock::now();
  try {
    denoise_picture(*denoiser_, channels_, *rows_, progress);
  } catch (const Error& error) {
    denoised_->failure = error;
  } catch (const std::bad_alloc&) {
    denoised_->failure = Error(ErrorKind::memory, "--denoise: out of memory; set a smaller --size");
  }
  writer_->write(*rows_);
  rows_.reset();
  denoised_->seconds += seconds_since(begun);
  if (denoised_->failure) denoiser_.reset();
}

void PictureOutput::finish(double seconds) {
  denoise([](double) {});
  writer_->finish(seconds);
  shown_ = writer_->png_light();
  writer_.reset();
  written_ = true;
}

void PictureOutput::write(const api::FilmJob& job, const GrowingFilm& film, double seconds) {
  const Clock::time_point begun = Clock::now();
  begin(job);
  film.resolve([&](const Band& band) { take(band); });
  finish(seconds);
  seconds_to_write_ = seconds_since(begun);
}

} // namespace pointgi
