#include "host/app/picture_output.h"
#include "octree/clock.h"

namespace pointgi {

PictureOutput::PictureOutput(std::string exr, std::optional<double> exposure)
    : exr_(std::move(exr)), png_(png_path_of(exr_)), exposure_(exposure) {}

void PictureOutput::begin(const api::FilmJob& job) {
  writer_.reset(); // removes its temporary files
  writer_ = std::make_unique<PictureWriter>(exr_, job.settings().width, job.settings().height, job.window(),
                                            job.channels(), job.attributes(), exposure_);
}

void PictureOutput::take(const Band& band) {
  writer_->write(band);
}

void PictureOutput::finish(double seconds) {
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
