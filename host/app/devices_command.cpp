#include "host/app/commands.h"
#include "host/cl/session.h"
#include "host/passes/variant.h"
#include <cstdio>
#include <nlohmann/json.hpp>

namespace pointgi {

namespace {

struct Build {
  std::string file;
  std::string options;
};

/// Every kernel file in every variant that the program can ask for.
std::vector<Build> every_build(const DeviceInfo& info) {
  std::vector<Build> builds{{"traverse/brute_force.cl", ""}};
  const auto add_render = [&](const TraversalVariant& variant) {
    builds.push_back({"render/eye_rays.cl", build_options(variant)});
    builds.push_back({"render/shade.cl", build_options(variant, {})});
    builds.push_back({"render/shade.cl", build_options(variant, {true, true, true})});
  };
  for (const unsigned lanes : {8u, 16u}) {
    if (!info.is_cpu) continue; // the wide form's precondition
    TraversalVariant variant;
    variant.form = TraversalForm::wide;
    variant.lanes = lanes;
    builds.push_back({"traverse/trace.cl", build_options(variant)});
    add_render(variant);
  }
  for (const PoolStorage storage : {PoolStorage::buffer, PoolStorage::image1d_buffer, PoolStorage::image2d})
    for (const Stepping stepping : {Stepping::exact, Stepping::absolute_delta})
      for (const unsigned axis_bits : {1u, 2u}) {
        if (storage != PoolStorage::buffer && !info.images) continue;
        TraversalVariant variant;
        variant.storage = storage;
        variant.stepping = stepping;
        variant.axis_bits = axis_bits;
        builds.push_back({"traverse/trace.cl", build_options(variant)});
        builds.push_back({"traverse/probe.cl", build_options(variant)});
        add_render(variant);
      }
  return builds;
}

std::string kind(const DeviceInfo& info) {
  return info.is_gpu ? "GPU" : info.is_cpu ? "CPU" : "accelerator";
}

/// Empty when every build succeeds, else the first failure's text.
std::string check_device(const Device& device, std::size_t& count) {
  try {
    Session session(device);
    const std::vector<Build> builds = every_build(device.info);
    for (const Build& build : builds)
      session.program(build.file, build.options);
    count = builds.size();
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

} // namespace

ExitCode run_devices(bool json, bool check, const std::string& selector) {
  std::vector<Device> devices = list_devices();
  if (!selector.empty() || devices.empty()) devices = {choose_device(selector)}; // throws with what there is
  nlohmann::json list = nlohmann::json::array();
  bool all_fine = true;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& info = devices[i].info;
    nlohmann::json entry{{"index", i},
                         {"name", info.name},
                         {"vendor", info.vendor},
                         {"platform", info.platform},
                         {"driver", info.driver},
                         {"opencl", info.opencl},
                         {"type", kind(info)},
                         {"compute_units", info.compute_units},
                         {"memory_bytes", info.memory_bytes},
                         {"max_allocation_bytes", info.max_allocation_bytes},
                         {"local_memory_bytes", info.local_memory_bytes},
                         {"max_work_group", info.max_work_group},
                         {"images", info.images}};
    if (!json)
      std::printf(
          "%zu  %s\n   %s, %u compute units, %llu MiB (%llu MiB in one piece), images: %s\n   %s, %s, driver %s\n", i,
          info.name.c_str(), kind(info).c_str(), info.compute_units,
          static_cast<unsigned long long>(info.memory_bytes >> 20),
          static_cast<unsigned long long>(info.max_allocation_bytes >> 20), info.images ? "yes" : "no",
          info.platform.c_str(), info.opencl.c_str(), info.driver.c_str());
    if (check) {
      std::size_t builds = 0;
      const std::string failure = check_device(devices[i], builds);
      all_fine = all_fine && failure.empty();
      entry["check"] = {{"passed", failure.empty()}, {"builds", builds}, {"message", failure}};
      if (!json)
        std::printf("   check: %s\n", failure.empty()
                                          ? ("all " + std::to_string(builds) + " kernel builds compile").c_str()
                                          : failure.c_str());
    }
    list.push_back(entry);
  }
  if (json) std::printf("%s\n", list.dump(1).c_str());
  return all_fine ? ExitCode::done : ExitCode::device;
}

} // namespace pointgi
