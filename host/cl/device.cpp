#include "host/cl/device.h"
#include "host/cl/device_choice.h"
#include "host/error.h"
#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace pointgi {

namespace {

/// Drivers pad their strings with blanks and sometimes a NUL.
std::string trimmed(std::string text) {
  text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// As if the device had no more than POINTGI_DEVICE_MEMORY says.
void limit_memory(DeviceInfo& info) {
  const char* text = std::getenv("POINTGI_DEVICE_MEMORY");
  if (text == nullptr || *text == '\0') return;
  std::uint64_t mebibytes = 0;
  const char* end = text + std::strlen(text);
  const auto [stopped, error] = std::from_chars(text, end, mebibytes);
  if (error != std::errc() || stopped != end || mebibytes == 0 || mebibytes > (1u << 30))
    throw Error(ErrorKind::usage, "POINTGI_DEVICE_MEMORY=" + std::string(text) +
                                      ": expected a number of MiB, for example 4096; correct it, or unset it");
  info.memory_bytes = std::min(info.memory_bytes, mebibytes << 20);
  info.max_allocation_bytes = std::min(info.max_allocation_bytes, info.memory_bytes);
}

DeviceInfo describe(const cl::Device& device, const cl::Platform& platform) {
  DeviceInfo info;
  info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
  info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
  info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
  info.opencl = trimmed(device.getInfo<CL_DEVICE_VERSION>());
  info.platform = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
  const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
  info.is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
  info.is_gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
  info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  info.local_memory_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  info.max_work_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  info.images = device.getInfo<CL_DEVICE_IMAGE_SUPPORT>() != CL_FALSE;
  if (info.images) {
    info.image_buffer_texels = device.getInfo<CL_DEVICE_IMAGE_MAX_BUFFER_SIZE>();
    info.image2d_width = device.getInfo<CL_DEVICE_IMAGE2D_MAX_WIDTH>();
    info.image2d_height = device.getInfo<CL_DEVICE_IMAGE2D_MAX_HEIGHT>();
  }
  limit_memory(info);
  return info;
}

} // namespace

std::vector<Device> list_devices() {
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return {}; // the loader reports "no platform" as an error
  }
  std::vector<Device> result;
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      const_cast<cl::Platform&>(platform).getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
      continue; // a platform without devices
    }
    for (const cl::Device& device : devices)
      try {
        result.push_back({device, describe(device, platform)});
      } catch (const cl::Error&) {
        continue; // a device that cannot say what it is cannot be used, and must not hide the others
      }
  }
  return result;
}

Device choose_device(const std::string& selector) {
  const std::vector<Device> devices = list_devices();
  return devices[choose_among(infos_of(devices), selector, [](std::size_t) { return std::string(); }).place];
}

} // namespace pointgi
