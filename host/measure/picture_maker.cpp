#include "host/measure/picture_maker.h"
#include "host/cache/vmap_cache.h"
#include <chrono>

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
  api::Scene::from_file(file_, overrides_);
}

const Scene& PictureMaker::scene(const RunControl& run) {
  return prepared({}, run).parts()->scene;
}

std::size_t PictureMaker::points(const RunControl& run) {
  return prepared({}, run).size();
}

void PictureMaker::set_size(int width, int height) {
  width_ = width;
  height_ = height;
}

/// Light and pixels read the settings of radiosity, caustics and samples anew for each picture: only what the octree
/// depends on needs another one.
api::Prepared& PictureMaker::prepared(const std::vector<std::string>& overrides, const RunControl& run) {
  std::vector<std::string> all = overrides_;
  all.insert(all.end(), overrides.begin(), overrides.end());
  const api::Scene scene = api::Scene::from_file(file_, all);
  const std::string key = preparing_overrides(overrides);
  if (!key.empty() && other_key_ != key) other_.reset(); // first its memory, then that of the next one
  std::unique_ptr<api::Prepared>& place = key.empty() ? own_ : other_;
  if (!place) {
    place = std::make_unique<api::Prepared>(context_, scene, run);
    if (!key.empty()) other_key_ = key;
  }
  const Scene wanted = scene.parts()->description();
  Scene& now = place->parts()->scene;
  now.radiosity = wanted.radiosity;
  now.caustics = wanted.caustics;
  now.render = wanted.render;
  return *place;
}

MadePicture PictureMaker::film(const api::Prepared& prepared, const api::LightOptions& how,
                               const api::FilmOptions& options, const RunControl& run) {
  using Clock = std::chrono::steady_clock;
  api::Prepared::Parts& parts = *prepared.parts();
  RenderSettings& render = parts.scene.render;
  if (options.seed) render.seed = *options.seed;
  if (options.spp) render.spp = *options.spp;
  parts.ready.lighting.params.seed = render.seed; // lights and materials stay what they are
  parts.ready.lighting.params.samples = static_cast<pg_uint>(render.spp);
  Session& session = context_.parts()->session;
  const std::vector<StageRecord>& records = context_.parts()->stages.records();
  const std::size_t stages_before = records.size(), programs = session.programs_asked().size(),
                    kernels = session.kernel_times().size();
  session.forget_peak();
  const NoVMapsKept anew;
  const auto begun = Clock::now();
  const api::Light light(prepared, how, run);
  const api::Film film(light, options, run);
  MadePicture made;
  made.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  made.picture = picture_of(film);
  made.memory_bytes = session.peak_bytes();
  for (std::size_t i = stages_before; i < records.size(); ++i)
    if (records[i].ran) made.stages[records[i].name] += records[i].seconds;
  const IndirectLight& indirect = light.parts()->light.indirect;
  made.method = indirect.method == nullptr ? "none" : indirect.method->name;
  made.compiled = session.programs_asked().size() != programs || session.kernel_times().size() != kernels;
  return made;
}

MadePicture PictureMaker::make(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run) {
  api::FilmOptions options;
  options.width = width_;
  options.height = height_;
  options.seed = seed;
  return film(prepared(overrides, run), {}, options, run);
}

MadePicture PictureMaker::trace(int samples, unsigned seed, const RunControl& run) {
  api::LightOptions how;
  how.path_tracing = true;
  api::FilmOptions options;
  options.width = width_;
  options.height = height_;
  options.seed = seed;
  options.spp = samples;
  return film(prepared({}, run), how, options, run);
}

} // namespace pointgi
