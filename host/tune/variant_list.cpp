#include "host/tune/variant_list.h"
#include "shared/cone_types.h"
#include "shared/render_types.h"
#include <algorithm>
#include <map>

namespace pointgi {

namespace {

using Variant = TraversalVariant;

bool wide(const Variant& v) {
  return v.form == TraversalForm::wide;
}
bool packets(const Variant& v) {
  return v.grouping == RayGrouping::packet;
}
bool wide_patches(const Variant& v) {
  return wide(v) && v.patches;
}
bool sixteen_lanes(const Variant& v) {
  return wide(v) && v.lanes == 16;
}
bool images(const Variant& v) {
  return v.storage != PoolStorage::buffer;
}
bool hilbert(const Variant& v) {
  return v.order == PointOrder::hilbert;
}
bool pairs(const Variant& v) {
  return v.group.size() > GRID_RAYS;
}

} // namespace

const std::vector<Precondition>& preconditions() {
  static const std::vector<Precondition> all{
      {"the wide form takes N = 2", wide, [](const Variant& v, const DeviceInfo&) { return v.axis_bits == 1; }},
      {"the wide form lies in plain buffers", wide, [](const Variant& v, const DeviceInfo&) { return !images(v); }},
      {"the wide form has no cells to step through: stepping is exact", wide,
       [](const Variant& v, const DeviceInfo&) { return v.stepping == Stepping::exact; }},
      {"packets go through the wide form", packets, [](const Variant& v, const DeviceInfo&) { return wide(v); }},
      {"packets want a work-item with vector registers of its own: a CPU device", packets,
       [](const Variant&, const DeviceInfo& d) { return d.is_cpu; }},
      {"patches in the wide form want a work-item with vector registers of its own: a CPU device", wide_patches,
       [](const Variant&, const DeviceInfo& d) { return d.is_cpu; }},
      {"16 lanes want vector registers as wide: a CPU device", sixteen_lanes,
       [](const Variant&, const DeviceInfo& d) { return d.is_cpu; }},
      {"Hilbert order goes with N = 2", hilbert, [](const Variant& v, const DeviceInfo&) { return v.axis_bits == 1; }},
      {"images want a device with images, large enough for the pools", images,
       [](const Variant&, const DeviceInfo& d) { return d.images; }},
      {"a work-group of 64 wants a device that gives 64", pairs,
       [](const Variant& v, const DeviceInfo& d) { return d.max_work_group >= v.group.size(); }},
      {"a work-group of 32 wants a device that gives 32", [](const Variant& v) { return !pairs(v); },
       [](const Variant& v, const DeviceInfo& d) { return d.max_work_group >= v.group.size(); }},
  };
  return all;
}

std::string why_not(const TraversalVariant& variant, const DeviceInfo& device) {
  for (const Precondition& p : preconditions())
    if (p.concerns(variant) && !p.holds(variant, device)) return p.sentence;
  return {};
}

TraversalVariant plain_variant(TraversalForm form) {
  TraversalVariant variant;
  variant.form = form;
  // Flat around these on the scans; larger leaves keep the pools below 90 bytes a splat.
  variant.leaf_capacity = form == TraversalForm::wide ? 64 : 32;
  return variant;
}

TraversalVariant reference_variant() {
  return plain_variant(TraversalForm::step);
}

namespace {

/// Calls `take` with every combination of the form that some device may run.
template <typename Take>
void for_every(TraversalForm form, const Take& take) {
  const DeviceInfo device = ideal_device(true);
  const bool is_wide = form == TraversalForm::wide;
  TraversalVariant v = plain_variant(form);
  for (v.axis_bits = 1; v.axis_bits <= 2; ++v.axis_bits)
    for (const PoolStorage storage : pool_storages())
      for (const PointOrder order : point_orders())
        for (const unsigned lanes : is_wide ? std::vector<unsigned>{8, 16} : std::vector<unsigned>{8})
          for (const unsigned leaf : is_wide ? std::vector<unsigned>{64, 32, 128} : std::vector<unsigned>{32, 16, 64})
            for (const RayGrouping grouping : ray_groupings())
              for (const WorkGroup group : work_groups()) {
                v.storage = storage, v.order = order, v.lanes = lanes, v.leaf_capacity = leaf;
                v.grouping = grouping, v.group = group;
                if (why_not(v, device).empty()) take(v);
              }
}

bool plain_but_for_kernel(const TraversalVariant& v) {
  return v.order == PointOrder::morton && v.leaf_capacity == plain_variant(v.form).leaf_capacity &&
         v.group == WorkGroup{};
}

} // namespace

std::vector<TraversalVariant> all_variants() {
  std::vector<TraversalVariant> exact, fast;
  for (const TraversalForm form : traversal_forms())
    for_every(form, [&](TraversalVariant v) {
      exact.push_back(v);
      if (!plain_but_for_kernel(v)) return; // what fast math gains does not depend on the tree
      v.fast_math = true;
      fast.push_back(v);
    });
  exact.insert(exact.end(), fast.begin(), fast.end());
  return exact;
}

std::vector<TraversalVariant> tracing_variants() {
  std::vector<TraversalVariant> result;
  for (const TraversalVariant& v : all_variants())
    if (!v.fast_math && (v.group == WorkGroup{8, 4} || v.group == WorkGroup{16, 4})) result.push_back(v);
  return result;
}

DeviceInfo ideal_device(bool cpu) {
  DeviceInfo info;
  info.is_cpu = cpu;
  info.is_gpu = !cpu;
  info.images = true;
  info.max_work_group = 1024;
  return info;
}

namespace {

/// What features_on() makes of any scene's picture where the device is no CPU.
std::vector<SceneFeatures> gpu_picture_features() {
  const auto with_materials = [](SceneFeatures features) {
    features.materials = all_materials;
    features.material_flags = all_material_flags;
    return features;
  };
  std::vector<SceneFeatures> sets{{}, with_materials({})};
  const auto add = [&](SceneFeatures light) {
    sets.push_back(light);
    SceneFeatures specular = with_materials(light);
    for (const unsigned k : {0u, 64u, 512u, 1024u}) {
      specular.gather_k = k;
      sets.push_back(specular);
    }
  };
  for (const SceneFeatures& light :
       {SceneFeatures{all_lights, true, true, false}, SceneFeatures{all_lights, true, true, true},
        SceneFeatures{SIZED_LIGHTS, true, false, true, false}})
    for (const bool sky_map : {false, true}) {
      SceneFeatures features = light;
      features.sky_map = sky_map;
      for (const unsigned texels : {0u, CONE_SIDES_ISOTROPIC, CONE_SIDES_ANISOTROPIC}) {
        features.cone_texels = texels;
        if (texels == 0 || features.radiosity) add(features);
      }
    }
  return sets;
}

} // namespace

std::vector<ProgramUse> all_programs() {
  std::vector<TraversalVariant> variants = all_variants();
  for (TraversalVariant v : all_variants())
    if (v.form == TraversalForm::step && !v.fast_math && plain_but_for_kernel(v)) {
      v.stepping = Stepping::absolute_delta;
      variants.push_back(v);
    }
  const auto usual = [](const TraversalVariant& v) {
    TraversalVariant plain = plain_variant(v.form);
    plain.clips = v.clips;
    plain.patches = v.patches;
    return build_options(v) == build_options(plain) && !v.fast_math;
  };
  for (std::size_t i = 0, count = variants.size(); i < count; ++i)
    if (usual(variants[i])) // with borders and with patches the usual walks stand for all
      for (unsigned surface = 1; surface < 4; ++surface) {
        variants.push_back(variants[i]);
        variants.back().clips = (surface & 1u) != 0;
        variants.back().patches = (surface & 2u) != 0;
      }
  std::vector<ProgramUse> uses;
  TraversalVariant scanned = reference_variant();
  for (unsigned surface = 0; surface < 4; ++surface) {
    scanned.clips = (surface & 1u) != 0;
    scanned.patches = (surface & 2u) != 0;
    for (const Backfaces backfaces : {Backfaces::shade, Backfaces::see_through})
      uses.push_back({scan_program(scanned, backfaces), true, true});
  }
  for (const char* file : {"radiosity/fmm/expand.cl", "radiosity/fmm/m2l.cl", "radiosity/fmm/near.cl",
                           "radiosity/direct/receive_from_all.cl", "radiosity/gather/receive_from_senders.cl",
                           "radiosity/gather/receive_picked.cl"})
    for (const bool cpu : {true, false})
      uses.push_back({fmm_program(file, fmm_lanes_on(ideal_device(cpu))), cpu, !cpu});
  uses.push_back({{"radiosity/directions/receive.cl", ""}, true, true});
  for (const Program& program : {sky_program(false, false), sky_program(false, true), sky_program(true, true)})
    uses.push_back({program, true, true});
  for (const unsigned voxels : {32u, 64u, 128u})
    for (const Program& program :
         {pairs_program({}, voxels), senders_program({}, voxels, false), senders_program({}, voxels, true)})
      uses.push_back({program, true, true});
  uses.push_back({cones_program("radiosity/cones/voxelise.cl"), true, true});
  for (const unsigned texels : {CONE_SIDES_ISOTROPIC, CONE_SIDES_ANISOTROPIC})
    for (const char* file : {"radiosity/cones/pyramid.cl", "radiosity/cones/trace.cl", "test/cone_probe.cl"})
      uses.push_back({cones_program(file, texels), true, true});
  for (const unsigned k : {64u, 512u, 1024u})
    for (const Program& program :
         {nearest_photons_program(k), caustic_irradiance_program(k), caustics_of_points_program(k)})
      uses.push_back({program, true, true});
  std::map<std::string, std::size_t> known;
  const auto add = [&](const Program& program, bool cpu, bool gpu) {
    const auto [at, is_new] = known.emplace(program.file + "\n" + program.options, uses.size());
    if (is_new) uses.push_back({program, false, false});
    uses[at->second].cpu |= cpu;
    uses[at->second].gpu |= gpu;
  };
  SceneFeatures everything{all_lights, true, true, true, true, all_materials, all_material_flags}, nothing;
  everything.stored_direct = nothing.stored_direct = true;
  const SceneFeatures traced{all_lights,        true, true, false, true, all_materials,
                             all_material_flags}; // by paths, photons
  for (const TraversalVariant& v : variants) {
    const bool cpu = why_not(v, ideal_device(true)).empty(), gpu = why_not(v, ideal_device(false)).empty();
    const bool usual_walk = usual(v);
    const bool usual_group = v.group == WorkGroup{};
    for (const Backfaces backfaces : {Backfaces::shade, Backfaces::see_through}) {
      add(trace_program(v, backfaces), cpu, gpu);
      add(eye_rays_program(v, backfaces), cpu, gpu);
    }
    if (usual_walk || usual_group) add(shade_program(v, everything), cpu, gpu);
    if (usual_group) add(shade_program(v, nothing), cpu, gpu);
    add(direct_irradiance_program(v, {all_lights, true, true}), cpu, gpu);
    for (const bool emitters : {false, true}) {
      SceneFeatures with_map{all_lights, emitters, true};
      with_map.sky_map = true;
      if (usual_walk) add(direct_irradiance_program(v, {all_lights, emitters, true}), cpu, gpu);
      if (usual_walk) add(direct_irradiance_program(v, with_map), cpu, gpu);
    }
    add(specular_rays_program(v), cpu, gpu);
    if (usual_walk && usual_group) add(samplers_program(v), cpu, gpu);
    add(segments_program(v), cpu, gpu);
    add(pairs_program(v), cpu, gpu);
    for (const bool monte_carlo : {false, true})
      add(senders_program(v, 0, monte_carlo), cpu, gpu);
    for (const bool hemicube : {false, true})
      add(directions_program(v, hemicube), cpu, gpu);
    add(path_program(v, traced, true), cpu, gpu);
    add(trace_photons_program(v, traced, PhotonStart::aimed), cpu, gpu);
    if (v.form == TraversalForm::step) add({"test/probe.cl", build_options(v)}, cpu, gpu);
    if (!usual_walk || !usual_group) continue;
    for (SceneFeatures features : gpu_picture_features())
      for (const bool auxiliary : {false, true}) {
        features.stored_direct = features.shadow_rays;
        features.auxiliary = auxiliary;
        add(shade_program(v, features), cpu, gpu);
      }
    for (const bool some_paths : {false, true})
      for (const bool specular : {false, true})
        for (const bool sky_map : {false, true})
          for (const bool auxiliary : {false, true}) {
            SceneFeatures features = traced;
            if (!specular) features.materials = features.material_flags = 0;
            features.sky_map = sky_map;
            features.auxiliary = auxiliary;
            add(path_program(v, features, some_paths), cpu, gpu);
          }
    for (const PhotonStart start : {PhotonStart::aimed, PhotonStart::equal_power, PhotonStart::from_surfaces})
      for (const bool from_lights : {false, true}) { // or from emitting splats and the environment alone
        SceneFeatures features = traced;
        if (!from_lights) features.lights = 0, features.emitters = features.environment = false;
        add(trace_photons_program(v, features, start), cpu, gpu);
        features.sky_map = true; // always among lights: features_on()
        if (from_lights && start != PhotonStart::from_surfaces)
          add(trace_photons_program(v, features, start), cpu, gpu);
      }
  }
  return uses;
}

} // namespace pointgi
