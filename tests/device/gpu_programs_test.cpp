/// What a GPU really builds is what `devices --check` and scripts/crosscompile check (host/tune/variant_list.h).
#include "host/render/render.h"
#include "host/stages/light_stages.h"
#include "host/stages/prepared_scene.h"
#include "host/tune/variant_list.h"
#include "tests/support/cache_folder.h"
#include "tests/support/device.h"
#include "tests/support/source_folder.h"
#include <catch2/catch.hpp>
#include <set>
#include <spdlog/spdlog.h>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// All stages of a picture, as the command makes one.
void make_picture(Session& session, Scene scene, const std::optional<LightPaths>& paths) {
  StageLog stages;
  const PreparedScene ready = prepare_scene(session, scene, false, stages);
  const auto never = [] { return false; };
  const IndirectRequest wanted{ready.choice.variant, scene,        ready.frame,
                               ready.lighting,       ready.points, paths.has_value()};
  const SceneLight light = run_light_stages(session, ready.on_device, wanted, stages);
  RenderRequest request{{0, scene.render.width, 0, scene.render.height},
                        ready.lighting,
                        ready.frame,
                        ready.ids,
                        ready.choice.variant,
                        paths};
  Buffer<cl_float4> irradiance;
  if (!light.indirect.from_surfaces.empty()) {
    irradiance = upload_irradiance(session, light.indirect, scene);
    request.irradiance = &irradiance;
    request.cones = light.indirect.at_pixels ? &*light.indirect.at_pixels : nullptr;
    request.shadow_rays = !direct_light_by_radiosity(scene);
  }
  request.normal_field = light.normal_field ? &*light.normal_field : nullptr;
  request.photons = light.photons ? &*light.photons : nullptr;
  render(
      session, ready.on_device, request, [](const Band&) {}, [](double) {}, never);
}

} // namespace

TEST_CASE("every program that a GPU is asked for when the demo is rendered is checked for GPUs", "[long]") {
  const CacheFolder empty; // a V-map that is kept would ask for nothing, a stored profile for another variant
  std::set<std::pair<std::string, std::string>> checked;
  for (const ProgramUse& use : all_programs())
    if (use.gpu) checked.emplace(use.program.file, use.program.options);
  const auto level = spdlog::get_level();
  spdlog::set_level(spdlog::level::err);
  Session session(faked_gpu());
  // Few points and photons: programs depend on what there is, not on how much.
  const Scene scene =
      load_scene(source_folder() + "/scenes/demo/room.toml",
                 {"render.size=[8,8]", "render.spp=1", "caustics.photons=20000", "radiosity.epsilon=0.1"});
  make_picture(session, scene, std::nullopt);
  Scene thesis = scene, bare = scene, cones = scene;
  thesis.radiosity.direct_light = "radiosity";
  thesis.caustics.power = "equal";
  thesis.caustics.gather_k = 50;
  make_picture(session, thesis, std::nullopt);
  bare.radiosity.method = "none";
  bare.caustics.photons = 0;
  make_picture(session, bare, std::nullopt);
  cones.radiosity.method = "cones";
  cones.radiosity.at = "pixels";
  make_picture(session, cones, std::nullopt);
  make_picture(session, scene, light_paths("", scene.render.max_depth));
  make_picture(session, scene, light_paths("LDE", scene.render.max_depth));
  spdlog::set_level(level);
  const auto asked = session.programs_asked();
  std::set<std::string> files;
  for (const auto& [file, options] : asked) {
    CAPTURE(file, options);
    CHECK(checked.count({file, options}) == 1);
    files.insert(file);
  }
  for (const char* file :
       {"radiosity/fmm/m2l.cl", "radiosity/point_irradiance.cl", "photon/trace_photons.cl",
        "photon/caustics_of_points.cl", "render/shade.cl", "render/path.cl", "visibility/segments.cl"})
    CHECK(files.count(file) == 1); // or the test has asked for too little
}

TEST_CASE("the sets of features that a GPU is given hold those of the scene, and are few") {
  const DeviceInfo gpu = ideal_device(false), cpu = ideal_device(true);
  std::set<std::string> checked;
  for (const ProgramUse& use : all_programs())
    if (use.gpu) checked.insert(use.program.file + "\n" + use.program.options);
  for (const TraversalForm form : {TraversalForm::step, TraversalForm::wide})
    for (unsigned bits = 0; bits < 512; ++bits)
      for (const unsigned k : {0u, 50u, 400u, 1024u}) {
        const auto bit = [&](unsigned i) { return (bits >> i & 1u) != 0; };
        // What host/render composes: without shadow rays only what shines by itself, and no photons without specular.
        SceneFeatures f{(bit(0) && bit(4) ? 1u << LIGHT_POINT : 0u) | (bit(0) && bit(8) ? 1u << LIGHT_SUN : 0u), bit(1),
                        bit(2) && bit(4), bit(3), bit(4)};
        f.materials =
            1u << MATERIAL_DIFFUSE | (bit(6) ? 1u << MATERIAL_GLASS : 0u) | (bit(7) ? 1u << MATERIAL_PHONG : 0u);
        f.material_flags = MATERIAL_REFLECTS_DIFFUSELY | (bit(5) ? MATERIAL_SPECULAR : 0u) |
                           (bit(6) ? MATERIAL_TRANSMITS : 0u) | (bit(7) ? MATERIAL_HAS_LOBE : 0u);
        f.gather_k = k;
        f.sky_map = bit(8); // seen without shadow rays, too
        f.stored_direct = f.shadow_rays;
        if (f.sky_map && f.shadow_rays && !f.environment) continue;
        if (!f.specular() && (bit(6) || bit(7) || k > 0)) continue;
        if (!f.shadow_rays && !f.radiosity) continue;
        if (k > 0 && f.lights == 0 && !f.emitters && !f.environment && !f.radiosity) continue; // light brings photons
        f.cone_texels = !f.radiosity ? 0u : k == 50u ? 6u : k == 400u ? 1u : 0u;
        const SceneFeatures given = features_on(gpu, f);
        TraversalVariant v = plain_variant(form);
        CAPTURE(bits, k);
        for (const bool patches : {false, true}) {
          v.patches = patches;
          CHECK(checked.count(shade_program(v, given).file + "\n" + shade_program(v, given).options) ==
                (why_not(v, gpu).empty() ? 1 : 0));
        }
        CHECK((given.lights & f.lights) == f.lights);
        CHECK(given.emitters >= f.emitters);
        CHECK(given.environment >= f.environment);
        if (f.specular()) CHECK((given.materials & f.materials) == f.materials);
        if (f.specular()) CHECK((given.material_flags & f.material_flags) == f.material_flags);
        CHECK(given.sky_map == f.sky_map);
        CHECK(given.radiosity == f.radiosity);
        CHECK(given.cone_texels == f.cone_texels);
        CHECK(given.shadow_rays == f.shadow_rays);
        CHECK(shade_program(v, features_on(cpu, f)).options == shade_program(v, f).options);
      }
}
