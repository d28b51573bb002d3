#include "host/passes/variant.h"
#include "shared/fmm_types.h"
#include <algorithm>

namespace pointgi {

namespace {

/// Kernels that traversal.fast_math may loosen; the answers of all others are bit-identical. Not -cl-fast-relaxed-math
/// and not -cl-finite-math-only: empty boxes and parallel rays are infinities, which these let compilers forget.
constexpr const char* fast_files[] = {"traverse/trace.cl", "render/eye_rays.cl", "render/shade.cl"};
constexpr const char* fast_options = " -cl-mad-enable -cl-no-signed-zeros -cl-denorms-are-zero";

Program program(const TraversalVariant& variant, const char* file, const std::string& more) {
  const bool may = std::any_of(std::begin(fast_files), std::end(fast_files),
                               [&](const char* fast) { return std::string(fast) == file; });
  return {file, build_options(variant) + more + (variant.fast_math && may ? fast_options : "")};
}

/// Nothing of a march through voxels depends on the traversal.
Program sight_program(const TraversalVariant& variant, const char* file, unsigned voxels, const std::string& more) {
  if (voxels == 0) return program(variant, file, more);
  return {file, "-D VISIBILITY_VOXELS=" + std::to_string(voxels) + more};
}

std::string group_options(WorkGroup group) {
  return " -D GROUP_X=" + std::to_string(group.x) + " -D GROUP_Y=" + std::to_string(group.y);
}

std::string backface_options(Backfaces backfaces) {
  return backfaces == Backfaces::see_through ? " -D FRONTS_ONLY" : "";
}

std::string light_options(unsigned lights) {
  if (lights == 0) return {};
  std::string options = " -D HAS_LIGHT_SOURCES";
  if ((lights & SIZED_LIGHTS) != 0) options += " -D HAS_LIGHT_DISCS";
#define OPTION(ID, name)                                                                                               \
  options += (lights >> LIGHT_##ID & 1u) != 0 ? " -D WITH_LIGHT_" #ID "=1" : " -D WITH_LIGHT_" #ID "=0";
  LIGHT_KINDS(OPTION)
#undef OPTION
  return options;
}

std::string material_options(unsigned materials, unsigned flags) {
  std::string options = " -D HAS_SPECULAR";
  if ((flags & MATERIAL_TRANSMITS) != 0) options += " -D HAS_TRANSMISSION";
  if ((flags & MATERIAL_HAS_LOBE) != 0) options += " -D HAS_LOBES";
#define OPTION(ID, name)                                                                                               \
  options += (materials >> MATERIAL_##ID & 1u) != 0 ? " -D WITH_" #ID "=1" : " -D WITH_" #ID "=0";
  MATERIAL_KINDS(OPTION)
#undef OPTION
  return options;
}

std::string feature_options(const SceneFeatures& features) {
  return light_options(features.lights) + (features.emitters ? " -D HAS_EMITTERS" : "") +
         (features.environment ? " -D HAS_ENVIRONMENT" : "") + (features.sky_map ? " -D HAS_SKY_MAP" : "") +
         (features.radiosity ? " -D HAS_RADIOSITY" : "") + (features.shadow_rays ? "" : " -D NO_SHADOW_RAYS") +
         (features.stored_direct ? " -D HAS_STORED_DIRECT" : "") +
         (features.cone_texels > 0 ? " -D HAS_CONES -D CONE_SIDES=" + std::to_string(features.cone_texels) : "") +
         (features.auxiliary ? " -D HAS_AUXILIARY" : "") +
         (features.specular() ? material_options(features.materials, features.material_flags) : "") +
         (features.gather_k > 0 ? " -D HAS_CAUSTICS -D GATHER_MOST=" + std::to_string(gather_room(features.gather_k))
                                : "");
}

} // namespace

SceneFeatures features_on(const DeviceInfo& device, const SceneFeatures& of_scene) {
  SceneFeatures f = of_scene;
  if (device.is_cpu) return f;
  f.materials = f.specular() ? all_materials : 0u;
  f.material_flags = f.specular() ? all_material_flags : 0u;
  const bool lit = f.lights != 0 || f.emitters || f.environment || f.radiosity || f.sky_map;
  if (lit) f.emitters = true;
  if (lit) f.lights = f.shadow_rays ? all_lights : SIZED_LIGHTS;
  if (lit && f.shadow_rays) f.environment = true;
  return f;
}

unsigned gather_room(unsigned k) {
  return k <= 64 ? 64 : k <= 512 ? 512 : 1024;
}

std::string name_of(const TraversalVariant& v) {
  const bool wide = v.form == TraversalForm::wide;
  std::string name = name_of(v.form);
  if (wide)
    name += "-lanes" + std::to_string(v.lanes);
  else
    name += "-n" + std::to_string(1u << v.axis_bits) + "-" + name_of(v.storage);
  name += std::string("-") + name_of(v.order) + "-leaf" + std::to_string(v.leaf_capacity) + "-" + name_of(v.grouping) +
          "-" + name_of(v.group);
  if (v.stepping == Stepping::absolute_delta) name += "-delta";
  return v.fast_math ? name + "-fast" : name;
}

namespace {

std::string surface_options(const TraversalVariant& variant) {
  return std::string(variant.patches ? " -D HAS_MLS" : "") + (variant.clips ? " -D HAS_CLIPS" : "");
}

} // namespace

std::string build_options(const TraversalVariant& variant) {
  const std::string surface = surface_options(variant);
  if (variant.form == TraversalForm::wide)
    return "-D TRAVERSAL_FORM=FORM_WIDE -D WIDE_LANES=" + std::to_string(variant.lanes) + surface;
  const char* storage = variant.storage == PoolStorage::buffer           ? "POOL_BUFFER"
                        : variant.storage == PoolStorage::image1d_buffer ? "POOL_IMAGE1D"
                                                                         : "POOL_IMAGE2D";
  std::string options = std::string("-D POOL_STORAGE=") + storage +
                        " -D OCTREE_AXIS_BITS=" + std::to_string(variant.axis_bits) +
                        " -D POOL_WIDTH_LOG2=" + std::to_string(image_width_log2) + surface;
  if (variant.stepping == Stepping::absolute_delta) options += " -D STEP_ABSOLUTE";
  return options;
}

Program trace_program(const TraversalVariant& variant, Backfaces backfaces) {
  return program(variant, "traverse/trace.cl",
                 (variant.grouping == RayGrouping::packet ? " -D RAY_PACKETS" : "") + backface_options(backfaces));
}

Program scan_program(const TraversalVariant& variant, Backfaces backfaces) {
  return {"test/brute_force.cl", backface_options(backfaces) + surface_options(variant)};
}

Program eye_rays_program(const TraversalVariant& variant, Backfaces backfaces) {
  return program(variant, "render/eye_rays.cl",
                 (variant.grouping == RayGrouping::packet ? " -D RAY_PACKETS" : group_options(variant.group)) +
                     backface_options(backfaces));
}

Program shade_program(const TraversalVariant& variant, const SceneFeatures& features) {
  return program(variant, "render/shade.cl", group_options(variant.group) + feature_options(features));
}

Program direct_irradiance_program(const TraversalVariant& variant, const SceneFeatures& features) {
  return program(variant, "radiosity/point_irradiance.cl", feature_options(features));
}

Program specular_rays_program(const TraversalVariant& variant) {
  return program(variant, "test/specular_rays.cl",
                 feature_options({0, false, false, false, true, all_materials, all_material_flags}));
}

Program samplers_program(const TraversalVariant& variant) {
  return program(variant, "test/samplers.cl",
                 feature_options({all_lights, true, true, false, true, all_materials, all_material_flags}));
}

Program segments_program(const TraversalVariant& variant) {
  return program(variant, "visibility/segments.cl", "");
}

Program pairs_program(const TraversalVariant& variant, unsigned voxels) {
  return sight_program(variant, "visibility/pairs.cl", voxels, "");
}

Program senders_program(const TraversalVariant& variant, unsigned voxels, bool monte_carlo) {
  return sight_program(variant, "visibility/senders_visible.cl", voxels, monte_carlo ? " -D MONTE_CARLO" : "");
}

bool directions_in_beams(const TraversalVariant& variant, bool hemicube) {
  return variant.grouping == RayGrouping::packet && !variant.patches && !hemicube;
}

Program directions_program(const TraversalVariant& variant, bool hemicube) {
  return program(variant, "radiosity/directions/trace.cl",
                 hemicube                                 ? " -D HEMICUBE"
                 : directions_in_beams(variant, hemicube) ? " -D RAY_PACKETS"
                                                          : "");
}

Program sky_program(bool hemicube, bool map) {
  return {"radiosity/directions/sky.cl", !map ? "" : hemicube ? "-D HAS_SKY_MAP -D HEMICUBE" : "-D HAS_SKY_MAP"};
}

Program path_program(const TraversalVariant& variant, const SceneFeatures& features, bool some_paths) {
  return program(variant, "render/path.cl",
                 group_options({}) + feature_options(features) + (some_paths ? " -D PATH_CLASSES" : ""));
}

Program fmm_program(const char* file, unsigned lanes) {
  return {file, lanes == FMM_LANES ? "" : "-D FMM_ITEM_LANES=" + std::to_string(lanes)};
}

unsigned fmm_lanes_on(const DeviceInfo& device) {
  return device.is_cpu ? FMM_LANES : 1;
}

std::size_t fmm_items_on(const DeviceInfo& device) {
  return FMM_LANES / fmm_lanes_on(device);
}

Program cones_program(const char* file, unsigned texels) {
  return {file, texels == 0 ? "" : "-D CONE_SIDES=" + std::to_string(texels)};
}

Program trace_photons_program(const TraversalVariant& variant, const SceneFeatures& features, PhotonStart start) {
  const char* option = start == PhotonStart::equal_power     ? " -D EQUAL_POWER"
                       : start == PhotonStart::from_surfaces ? " -D FROM_SURFACES"
                                                             : "";
  return program(variant, "photon/trace_photons.cl", feature_options(features) + option);
}

Program caustic_irradiance_program(unsigned k) {
  return {"photon/irradiance.cl", "-D GATHER_MOST=" + std::to_string(gather_room(k))};
}

Program caustics_of_points_program(unsigned k) {
  return {"photon/caustics_of_points.cl", "-D GATHER_MOST=" + std::to_string(gather_room(k))};
}

Program nearest_photons_program(unsigned k) {
  return {"test/nearest_photons.cl", "-D GATHER_MOST=" + std::to_string(gather_room(k))};
}

} // namespace pointgi
