#include "host/cl/device_choice.h"
#include "host/error.h"
#include <algorithm>
#include <cctype>
#include <numeric>

namespace pointgi {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string listing(const std::vector<DeviceInfo>& devices) {
  std::string text;
  for (std::size_t i = 0; i < devices.size(); ++i)
    text += "\n  " + std::to_string(i) + "  " + devices[i].name + " (" + devices[i].platform + ")";
  return text;
}

bool is_number(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

/// The place that a selector which is not empty names.
std::size_t named_place(const std::vector<DeviceInfo>& devices, const std::string& selector) {
  const std::string wanted = lower(selector);
  if (is_number(selector)) {
    const std::size_t place = selector.size() < 9 ? std::stoul(selector) : devices.size();
    if (place < devices.size()) return place;
  } else {
    for (const std::size_t place : by_preference(devices)) {
      const DeviceInfo& info = devices[place];
      const bool is_it = wanted == "gpu"   ? info.is_gpu
                         : wanted == "cpu" ? info.is_cpu
                                           : lower(info.name).find(wanted) != std::string::npos;
      if (is_it) return place;
    }
  }
  throw Error(ErrorKind::device, "device '" + selector + "' was not found; there is:" + listing(devices));
}

} // namespace

std::vector<DeviceInfo> infos_of(const std::vector<Device>& devices) {
  std::vector<DeviceInfo> infos;
  for (const Device& device : devices)
    infos.push_back(device.info);
  return infos;
}

std::vector<std::size_t> by_preference(const std::vector<DeviceInfo>& devices) {
  const auto rank = [&](std::size_t place) { return devices[place].is_gpu ? 0 : devices[place].is_cpu ? 1 : 2; };
  std::vector<std::size_t> places(devices.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return devices[a].is_gpu && devices[a].memory_bytes > devices[b].memory_bytes;
  });
  return places;
}

DeviceChoice choose_among(const std::vector<DeviceInfo>& devices, const std::string& selector, const DeviceTest& test) {
  if (devices.empty())
    throw Error(ErrorKind::device, "no OpenCL device was found; install your vendor's OpenCL driver, or "
                                   "pocl-opencl-icd to run on the CPU");
  const auto fault_of = [&](std::size_t place) { return devices[place].is_cpu ? std::string() : test(place); };
  DeviceChoice choice;
  if (!selector.empty()) {
    choice.place = named_place(devices, selector);
    const std::string fault = fault_of(choice.place);
    if (!fault.empty())
      throw Error(ErrorKind::device, devices[choice.place].name + " does not pass its self-test: " + fault +
                                         "\n; use another --device, or a newer driver");
    return choice;
  }
  for (const std::size_t place : by_preference(devices)) {
    const std::string fault = fault_of(place);
    if (fault.empty()) {
      choice.place = place;
      return choice;
    }
    choice.warnings.push_back(devices[place].name + " is not used, it does not pass its self-test: " + fault);
  }
  std::string all;
  for (const std::string& warning : choice.warnings)
    all += "\n" + warning;
  throw Error(ErrorKind::device,
              "no OpenCL device works:" + all + "\n; install a newer driver, or pocl-opencl-icd to run on the CPU");
}

} // namespace pointgi
