#include "host/app/preview.h"
#include "host/run.h"
#include <algorithm>
#include <limits>

namespace pointgi {

namespace {

/// Rays a second that a slow CPU traces between points: a guess, as nothing is known of the device yet.
constexpr double slow_rays = 1.5e6;
/// Fewer directions than the first are worse than none, more than the second are no preview.
constexpr int least_directions = 8, most_directions = 32;
constexpr int samples = 2;

/// The settings of a preview, until its end those of the scene again.
class CheapSettings {
public:
  CheapSettings(api::Prepared::Parts& prepared, double seconds) : scene_(prepared.scene), own_(prepared.scene) {
    RadiositySettings& r = scene_.radiosity;
    const double directions =
        slow_rays * seconds / static_cast<double>(std::max<std::size_t>(1, prepared.points().size));
    if (r.method != "none") {
      const RadiositySettings usual;
      r = usual;
      r.method = directions < least_directions ? "none" : "directions";
      r.directions = std::clamp(static_cast<int>(directions), least_directions, most_directions);
    }
    r.light_samples = 1;
    r.tolerance = 0.1;
    scene_.caustics = {};
    scene_.caustics.photons = 0;
  }
  ~CheapSettings() {
    scene_.radiosity = own_.radiosity;
    scene_.caustics = own_.caustics;
  }
  /// Of the light; 0 where none is asked.
  int directions() const { return scene_.radiosity.method == "none" ? 0 : scene_.radiosity.directions; }
  bool leaves_out_light() const { return own_.radiosity.method != scene_.radiosity.method && directions() == 0; }
  CheapSettings(const CheapSettings&) = delete;
  CheapSettings& operator=(const CheapSettings&) = delete;

private:
  struct Own {
    explicit Own(const Scene& scene) : radiosity(scene.radiosity), caustics(scene.caustics) {}
    RadiositySettings radiosity;
    CausticSettings caustics;
  };
  Scene& scene_;
  Own own_;
};

} // namespace

PreviewCost write_preview(const api::Context& context, const api::Prepared& prepared, const api::FilmOptions& film,
                          double seconds, PictureOutput& output, const RunControl& run) {
  StageLog& stages = context.parts()->stages;
  stages.start("preview");
  PreviewCost cost;
  std::uint64_t pixels = 0;
  {
    const RunControl silent{run.stop, {}, {}};
    const RunScope scope(silent);
    const CheapSettings cheap(*prepared.parts(), seconds);
    const StagesApart apart(stages);
    const double asked = stages.seconds();
    const api::Light light(prepared, {}, silent);
    if (cheap.leaves_out_light())
      cost.seconds_a_direction = std::numeric_limits<double>::infinity();
    else if (cheap.directions() > 0)
      cost.seconds_a_direction = (stages.seconds() - asked) / cheap.directions();
    api::FilmOptions few = film;
    few.spp = samples;
    api::FilmJob job(*light.parts(), few);
    GrowingFilm growing = job.growing();
    growing.load_kernels();
    const double begun = stages.seconds();
    growing.grow(
        samples, [](double) {}, stop_asked);
    cost.seconds_a_sample = (stages.seconds() - begun) / samples;
    stop_if_asked();
    output.write(job, growing, stages.seconds());
    const PixelWindow& w = job.window();
    pixels = static_cast<std::uint64_t>(w.x1 - w.x0) * (w.y1 - w.y0);
  }
  stages.finish(pixels, "pixels");
  return cost;
}

} // namespace pointgi
