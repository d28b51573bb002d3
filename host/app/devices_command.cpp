#include "host/app/commands.h"
#include "host/cl/session.h"
#include "host/tune/self_test.h"
#include "host/tune/variant_list.h"
#include <cstdio>
#include <nlohmann/json.hpp>

namespace pointgi {

namespace {

/// Every program of the variants that this kind of device may run.
std::vector<Program> every_program(const DeviceInfo& info) {
  std::vector<Program> programs;
  for (const ProgramUse& use : all_programs())
    if (info.is_cpu ? use.cpu : use.gpu)
      if (info.images || use.program.options.find("POOL_IMAGE") == std::string::npos) programs.push_back(use.program);
  return programs;
}

std::string kind(const DeviceInfo& info) {
  return info.is_gpu ? "GPU" : info.is_cpu ? "CPU" : "accelerator";
}

/// Empty when every build succeeds and the device answers right, else the first failure's text.
std::string check_device(const Device& device, std::size_t& count) {
  try {
    Session session(device);
    const std::vector<Program> programs = every_program(device.info);
    for (const Program& program : programs)
      session.program(program.file, program.options);
    count = programs.size();
    return self_test(session);
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
        std::printf(
            "   check: %s\n",
            failure.empty()
                ? ("all " + std::to_string(builds) + " kernel builds compile, and its answers are right").c_str()
                : failure.c_str());
    }
    list.push_back(entry);
  }
  if (json) std::printf("%s\n", list.dump(1).c_str());
  return all_fine ? ExitCode::done : ExitCode::device;
}

} // namespace pointgi
