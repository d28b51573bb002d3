#pragma once
/// Which OpenCL devices there are, and which one to use.
#include <CL/opencl.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi {

/// What users and caches need to know of a device.
struct DeviceInfo {
  std::string name;
  std::string vendor;
  std::string driver; ///< driver version
  std::string opencl; ///< "OpenCL 1.2 ..." as the device says
  std::string platform;
  bool is_cpu = false;
  bool is_gpu = false;
  unsigned compute_units = 0;
  std::uint64_t memory_bytes = 0;
  std::uint64_t max_allocation_bytes = 0;
  std::uint64_t local_memory_bytes = 0;
  std::size_t max_work_group = 0;
  bool images = false;
  std::size_t image_buffer_texels = 0; ///< largest image1d_buffer
  std::size_t image2d_width = 0, image2d_height = 0;
};

struct Device {
  cl::Device handle;
  DeviceInfo info;
};

/// All devices of all platforms, in the platforms' order; empty when there is none. Their memory is at most
/// POINTGI_DEVICE_MEMORY, MiB, where that variable is set. Throws Error(usage) where it is no such number.
std::vector<Device> list_devices();

/// By `selector`: an index of list_devices(), "cpu", "gpu", or a part of a name (case does not matter); empty: the
/// GPU of most memory, else a CPU device, else any. None is tested (host/tune/self_test.h: choose_tested_device).
/// Throws Error(device) that lists what there is.
Device choose_device(const std::string& selector);

} // namespace pointgi
