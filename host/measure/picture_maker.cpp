#include "host/measure/picture_maker.h"
#include "host/cache/vmap_cache.h"
#include "octree/clock.h"
#include <algorithm>

namespace pointgi {

namespace {

/// Those that the octree and the surface on the device depend on.
std::string preparing_overrides(const std::vector<std::string>& overrides) {
  std::string key;
  for (const std::string& text : overrides)
    if (text.rfind("octree.", 0) == 0 || text.rfind("traversal.", 0) == 0) key += text + "\n";
  return key;
}

Picture picture_of(const api::Film& film) {
  Picture picture;
  picture.width = picture.full_width = film.width();
  picture.height = picture.full_height = film.height();
  picture.window = {0, film.width(), 0, film.height()};
  for (const std::string& name : film.channels())
    picture.channels[name] = film.channel(name);
  return picture;
}

} // namespace

PictureMaker::PictureMaker(const api::Context& context, std::string file, std::vector<std::string> overrides)
    : context_(context), file_(std::move(file)), overrides_(std::move(overrides)) {
  first_seed_ = api::Scene::from_file(file_, overrides_).parts()->description().render.seed;
}

const Scene& PictureMaker::scene(const RunControl& run) {
  return prepared({}, first_seed_, run).parts()->scene;
}

std::size_t PictureMaker::points(const RunControl& run) {
  return prepared({}, first_seed_, run).size();
}

void PictureMaker::set_size(int width, int height) {
  width_ = width;
  height_ = height;
}

/// Light and pixels read the settings of radiosity, caustics and samples anew for each picture: only what the octree
/// depends on needs another one.
api::Prepared& PictureMaker::prepared(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run) {
  std::vector<std::string> all = overrides_;
  all.insert(all.end(), overrides.begin(), overrides.end());
  const api::Scene scene = api::Scene::from_file(file_, all);
  const std::string key = preparing_overrides(overrides);
  if (!key.empty() && other_key_ != key && other_) { // first its memory, then that of the next one
    lights_.remove_if([&](const KeptLight& k) { return k.light->parts()->prepared == other_->parts(); });
    other_.reset();
  }
  std::unique_ptr<api::Prepared>& place = key.empty() ? own_ : other_;
  if (!place) {
    const auto begun = Clock::now();
    place = std::make_unique<api::Prepared>(context_, scene, run);
    if (key.empty()) prepare_seconds_ = seconds_since(begun);
    if (!key.empty()) other_key_ = key;
  }
  const Scene wanted = scene.parts()->description();
  Scene& now = place->parts()->scene;
  now.radiosity = wanted.radiosity;
  now.caustics = wanted.caustics;
  now.render = wanted.render;
  now.render.seed = place->parts()->ready.lighting.params.seed = seed;
  return *place;
}

namespace {

/// What the stages and kernels of a context do while one lives.
class Watch {
public:
  /// `bytes_of_others`: what the device holds for other pictures.
  Watch(api::Context::Parts& context, std::uint64_t bytes_of_others)
      : context_(context), bytes_of_others_(bytes_of_others), stages_(context.stages.records().size()),
        programs_(context.session.programs_asked().size()), kernels_(context.session.kernel_times().size()) {
    context.session.forget_peak();
  }
  void tell(MadePicture& made) const {
    made.seconds += seconds_since(begun_);
    made.memory_bytes = std::max(made.memory_bytes, context_.session.peak_bytes() -
                                                        std::min(bytes_of_others_, context_.session.peak_bytes()));
    const std::vector<StageRecord>& records = context_.stages.records();
    for (std::size_t i = stages_; i < records.size(); ++i)
      if (records[i].ran) made.stages[records[i].name] += records[i].seconds;
    made.compiled = made.compiled || context_.session.programs_asked().size() != programs_ ||
                    context_.session.kernel_times().size() != kernels_;
  }

private:
  api::Context::Parts& context_;
  std::uint64_t bytes_of_others_;
  std::size_t stages_, programs_, kernels_;
  Clock::time_point begun_ = Clock::now();
};

/// Of the device's memory, for the lights that are kept.
constexpr double share_of_lights = 0.125;

/// Lights that are kept at most: on the host they hold some floats a point as well.
constexpr std::size_t most_lights = 64;

} // namespace

/// What the light depends on. Where points take as many light samples as pixels have, of the samples, too.
std::string PictureMaker::light_key(const std::vector<std::string>& overrides, unsigned seed) const {
  std::vector<std::string> all = overrides_;
  all.insert(all.end(), overrides.begin(), overrides.end());
  const Scene scene = api::Scene::from_file(file_, all).parts()->description();
  std::string key = std::to_string(seed) + "\n";
  if (direct_light_by_radiosity(scene) && !scene.radiosity.light_samples)
    key += "samples " + std::to_string(scene.render.spp) + "\n";
  for (const std::string& text : overrides)
    if (text.rfind("render.", 0) != 0) key += text + "\n";
  return key;
}

std::uint64_t PictureMaker::bytes_of_others(const KeptLight* light) const {
  std::uint64_t bytes = 0;
  for (const KeptLight& other : lights_)
    if (&other != light) bytes += other.bytes;
  return bytes;
}

PictureMaker::KeptLight PictureMaker::solve(const api::Prepared& prepared, bool by_paths, const RunControl& run) {
  KeptLight kept;
  api::LightOptions how;
  how.path_tracing = by_paths;
  Session& session = context_.parts()->session;
  const std::uint64_t before = session.held_bytes();
  const Watch watch(*context_.parts(), bytes_of_others(nullptr));
  kept.light = std::make_unique<api::Light>(prepared, how, run);
  watch.tell(kept.cost);
  const std::uint64_t after = session.held_bytes();
  kept.bytes = after - std::min(before, after); // drivers give memory back late
  const IndirectLight& indirect = kept.light->parts()->light.indirect;
  kept.cost.method = indirect.method == nullptr ? "none" : indirect.method->name;
  return kept;
}

MadePicture PictureMaker::film(const KeptLight& light, const api::FilmOptions& options, const RunControl& run) {
  MadePicture made = light.cost;
  const Watch watch(*context_.parts(), bytes_of_others(&light));
  const api::Film film(*light.light, options, run);
  watch.tell(made);
  made.picture = picture_of(film);
  made.samples = options.spp.value_or(light.light->parts()->prepared->scene.render.spp);
  return made;
}

api::FilmOptions PictureMaker::film_options(unsigned seed) const {
  api::FilmOptions options;
  options.width = width_;
  options.height = height_;
  options.seed = seed;
  return options;
}

MadePicture PictureMaker::make(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run) {
  const api::Prepared& prepared_scene = prepared(overrides, seed, run);
  const std::string key = light_key(overrides, seed);
  const auto known = std::find_if(lights_.begin(), lights_.end(), [&](const KeptLight& k) { return k.key == key; });
  if (known != lights_.end()) {
    lights_.splice(lights_.begin(), lights_, known);
    return film(lights_.front(), film_options(seed), run);
  }
  const NoVMapsKept anew;
  const auto most =
      static_cast<std::uint64_t>(share_of_lights * static_cast<double>(context_.parts()->session.info().memory_bytes));
  while (!lights_.empty() && (bytes_of_others(nullptr) > most || lights_.size() >= most_lights))
    lights_.pop_back();
  KeptLight light;
  try {
    light = solve(prepared_scene, false, run);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::memory || lights_.empty()) throw;
    lights_.clear(); // perhaps their memory is what lacks
    light = solve(prepared_scene, false, run);
  }
  MadePicture made = film(light, film_options(seed), run);
  if (made.compiled) return made; // its time is not to be counted
  light.key = key;
  lights_.push_front(std::move(light));
  return made;
}

double PictureMaker::kept_seconds(const std::vector<std::string>& overrides, unsigned seed) const {
  const std::string key = light_key(overrides, seed);
  for (const KeptLight& light : lights_)
    if (light.key == key) return light.cost.seconds;
  return 0.0;
}

MadePicture PictureMaker::make_warm(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run) {
  const api::Prepared& prepared_scene = prepared(overrides, seed, run);
  solve(prepared_scene, false, run); // keeps the map, if it is not kept yet
  return film(solve(prepared_scene, false, run), film_options(seed), run);
}

MadePicture PictureMaker::trace(int samples, unsigned seed, const RunControl& run) {
  const api::Prepared& prepared_scene = prepared({}, seed, run);
  api::FilmOptions options = film_options(seed);
  options.spp = samples;
  return film(solve(prepared_scene, true, run), options, run);
}

} // namespace pointgi
