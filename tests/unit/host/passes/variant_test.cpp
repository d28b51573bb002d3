#include "host/tune/variant_list.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using Catch::Contains;

TEST_CASE("every variant of the list has its own name, is valid somewhere, and the reference stands first") {
  const auto all = all_variants();
  CHECK(name_of(all.front()) == name_of(reference_variant()));
  CHECK(name_of(all.front()) == "step-n2-buffer-morton-leaf32-ray-8x4");
  std::set<std::string> names;
  for (const TraversalVariant& v : all) {
    CAPTURE(name_of(v));
    CHECK(names.insert(name_of(v)).second);
    CHECK((why_not(v, ideal_device(true)).empty() || why_not(v, ideal_device(false)).empty()));
  }
  // Every choice is there, in some variant.
  const auto named = [&](const std::string& part) {
    return std::count_if(names.begin(), names.end(), [&](const auto& n) { return n.find(part) != std::string::npos; });
  };
  for (const char* part :
       {"step-n2", "step-n4", "wide-lanes8", "wide-lanes16", "-buffer-", "-image1d_buffer-", "-image2d-", "-morton-",
        "-hilbert-", "-leaf16-", "-leaf128-", "-ray-", "-packet-", "-8x4", "-32x1", "-16x4", "-64x1", "-fast"})
    CHECK(named(part) > 0);
}

TEST_CASE("variants say why they are not valid") {
  TraversalVariant v = plain_variant(TraversalForm::step);
  const DeviceInfo cpu = ideal_device(true), gpu = ideal_device(false);
  CHECK(why_not(v, cpu).empty());
  CHECK(why_not(v, gpu).empty());
  v.grouping = RayGrouping::packet;
  CHECK_THAT(why_not(v, cpu), Contains("packets go through the wide form"));
  v.form = TraversalForm::wide;
  CHECK(why_not(v, cpu).empty());
  CHECK_THAT(why_not(v, gpu), Contains("CPU device"));
  v.axis_bits = 2;
  CHECK_THAT(why_not(v, cpu), Contains("N = 2"));
  v = plain_variant(TraversalForm::wide);
  v.storage = PoolStorage::image2d;
  CHECK_THAT(why_not(v, cpu), Contains("plain buffers"));
  v = plain_variant(TraversalForm::wide);
  v.stepping = Stepping::absolute_delta;
  CHECK_THAT(why_not(v, cpu), Contains("stepping is exact"));
  v = plain_variant(TraversalForm::step);
  v.axis_bits = 2;
  CHECK(why_not(v, cpu).empty());
  v.order = PointOrder::hilbert;
  CHECK_THAT(why_not(v, cpu), Contains("Hilbert"));
  v = plain_variant(TraversalForm::step);
  v.storage = PoolStorage::image1d_buffer;
  DeviceInfo plain = ideal_device(false);
  plain.images = false;
  CHECK_THAT(why_not(v, plain), Contains("images"));
  v = plain_variant(TraversalForm::step);
  v.group = {64, 1};
  plain.max_work_group = 32;
  CHECK_THAT(why_not(v, plain), Contains("gives 64"));
  v.group = {32, 1};
  CHECK(why_not(v, plain).empty());
  plain.max_work_group = 16;
  CHECK_THAT(why_not(v, plain), Contains("gives 32"));
}

TEST_CASE("options depend on what a kernel reads, fast math on the kernels that may have it") {
  TraversalVariant v = plain_variant(TraversalForm::step);
  v.group = {16, 4};
  CHECK_THAT(shade_program(v, {}).options, Contains("GROUP_X=16") && Contains("GROUP_Y=4"));
  CHECK_THAT(eye_rays_program(v).options, Contains("GROUP_X=16") && Contains("GROUP_Y=4"));
  CHECK_THAT(trace_program(v).options, !Contains("GROUP"));
  CHECK_THAT(shade_program(v, {true, false, true}).options,
             Contains("HAS_LIGHT_SOURCES") && !Contains("HAS_EMITTERS") && Contains("HAS_ENVIRONMENT"));
  v.fast_math = true;
  CHECK_THAT(shade_program(v, {}).options, Contains("-cl-mad-enable") && !Contains("finite"));
  CHECK_THAT(trace_program(v).options, Contains("-cl-mad-enable"));
  CHECK_THAT(build_options(v), !Contains("-cl-mad-enable"));
  v = plain_variant(TraversalForm::wide);
  CHECK_THAT(eye_rays_program(v).options, !Contains("RAY_PACKETS") && !Contains("FRONTS_ONLY"));
  CHECK_THAT(eye_rays_program(v, Backfaces::see_through).options, Contains("FRONTS_ONLY"));
  v.grouping = RayGrouping::packet;
  CHECK_THAT(eye_rays_program(v).options, Contains("RAY_PACKETS") && !Contains("GROUP"));
  CHECK_THAT(trace_program(v).options, Contains("RAY_PACKETS"));
  CHECK_THAT(shade_program(v, {}).options, !Contains("RAY_PACKETS"));
}

TEST_CASE("kernels of a scene without specular surfaces know nothing of them") {
  const TraversalVariant v = plain_variant(TraversalForm::wide);
  const SceneFeatures diffuse{all_lights, true, true, true, true, 1u << MATERIAL_DIFFUSE, MATERIAL_REFLECTS_DIFFUSELY};
  for (const Program& program : {shade_program(v, diffuse), path_program(v, diffuse, true), eye_rays_program(v),
                                 direct_irradiance_program(v, diffuse), segments_program(v), trace_program(v)})
    for (const char* feature : {"SPECULAR", "TRANSMISSION", "LOBES", "WITH_MIRROR", "WITH_GLASS"})
      CHECK_THAT(program.options, !Contains(feature));
  SceneFeatures mirrors = diffuse;
  mirrors.materials |= 1u << MATERIAL_MIRROR;
  mirrors.material_flags |= MATERIAL_SPECULAR;
  CHECK_THAT(shade_program(v, mirrors).options, Contains("HAS_SPECULAR") && Contains("WITH_MIRROR=1") &&
                                                    Contains("WITH_GLASS=0") && !Contains("TRANSMISSION") &&
                                                    !Contains("LOBES"));
  mirrors.materials |= 1u << MATERIAL_GLASS | 1u << MATERIAL_PHONG;
  mirrors.material_flags |= MATERIAL_TRANSMITS | MATERIAL_HAS_LOBE;
  CHECK_THAT(path_program(v, mirrors, false).options, Contains("WITH_GLASS=1") && Contains("WITH_PHONG=1") &&
                                                          Contains("HAS_TRANSMISSION") && Contains("HAS_LOBES"));
}

TEST_CASE("pictures whose pixels trace no cones know nothing of voxels") {
  const TraversalVariant v = plain_variant(TraversalForm::wide);
  SceneFeatures features{all_lights, true, true, true};
  CHECK_THAT(shade_program(v, features).options, !Contains("CONE"));
  features.cone_texels = 6;
  CHECK_THAT(shade_program(v, features).options, Contains("HAS_CONES") && Contains("CONE_SIDES=6"));
  CHECK(cones_program("radiosity/cones/voxelise.cl").options.empty());
  for (const bool auxiliary : {false, true}) { // only where a denoiser is guided
    features.auxiliary = auxiliary;
    for (const Program& program : {shade_program(v, features), path_program(v, features, false)})
      CHECK((program.options.find("HAS_AUXILIARY") != std::string::npos) == auxiliary);
  }
  CHECK_THAT(cones_program("radiosity/cones/trace.cl", 1).options, Contains("CONE_SIDES=1"));
}

TEST_CASE("light between surfaces goes by whole blocks on CPU devices and by one lane a work-item on others") {
  const DeviceInfo cpu = ideal_device(true), gpu = ideal_device(false);
  CHECK(fmm_lanes_on(cpu) * fmm_items_on(cpu) == 8);
  CHECK(fmm_lanes_on(gpu) * fmm_items_on(gpu) == 8);
  CHECK(fmm_items_on(cpu) == 1);
  const std::vector<ProgramUse> programs = all_programs();
  std::size_t of_cpus = 0, of_gpus = 0;
  for (const ProgramUse& use : programs) {
    const Program on_cpu = fmm_program(use.program.file.c_str(), fmm_lanes_on(cpu)),
                  on_gpu = fmm_program(use.program.file.c_str(), fmm_lanes_on(gpu));
    CHECK(on_cpu.options.empty());
    if (use.program.options != on_gpu.options) continue;
    CHECK((use.gpu && !use.cpu));
    ++of_gpus;
    for (const ProgramUse& other : programs)
      of_cpus += other.program.file == use.program.file && other.program.options.empty() && other.cpu && !other.gpu;
  }
  CHECK(of_gpus == 6);
  CHECK(of_cpus == of_gpus);
}

TEST_CASE("each program is listed once, with the devices that may run it") {
  std::set<std::string> seen;
  std::size_t cpu_only = 0;
  for (const ProgramUse& use : all_programs()) {
    CHECK(seen.insert(use.program.file + " " + use.program.options).second);
    CHECK((use.cpu || use.gpu));
    if (use.program.options.find("RAY_PACKETS") != std::string::npos) CHECK_FALSE(use.gpu);
    cpu_only += !use.gpu;
  }
  CHECK(cpu_only > 0);
  CHECK(seen.count("test/probe.cl " + build_options(reference_variant())) == 1);
}
