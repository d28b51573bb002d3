/// A stand-in for Open Image Denoise 2, so that tests need no such library. It has the functions that the program
/// calls. Its filter halves albedo and normal alone, and makes color * (1 + albedo + normal) of a light. FAKE_OIDN in
/// the environment names a fault: "old", "no device", "commit", "filter", "memory", "crash", "nan", or "late": a
/// failure of all pictures but the one that the program tries. FAKE_OIDN_LOG: a file that gets a line a filter.
/// FAKE_OIDN_LACKING: without two of the functions. FAKE_OIDN_1: those of version 1.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

struct Image {
  float* data = nullptr;
  std::size_t width = 0, height = 0, offset = 0, pixel_stride = 0, row_stride = 0;
  int format = 0;

  float& at(std::size_t x, std::size_t y, std::size_t k) const {
    return *reinterpret_cast<float*>(reinterpret_cast<char*>(data) + offset + y * row_stride + x * pixel_stride +
                                     k * sizeof(float));
  }
};

struct Device {
  std::map<std::string, int> ints;
  int error = 0;
  std::string message, told;
  bool committed = false;
};

struct Filter {
  Device* device;
  std::string type;
  std::map<std::string, Image> images;
  std::map<std::string, bool> bools;
  bool committed = false;
};

bool fault(const char* name) {
  const char* const set = std::getenv("FAKE_OIDN");
  return set != nullptr && std::strcmp(set, name) == 0;
}

[[maybe_unused]] void fail(Device& device, int error, const char* message) {
  if (device.error != 0) return; // the first one stays
  device.error = error;
  device.message = message;
}

[[maybe_unused]] void log(const Filter& filter) {
  const char* const path = std::getenv("FAKE_OIDN_LOG");
  std::FILE* const file = path != nullptr ? std::fopen(path, "a") : nullptr;
  if (file == nullptr) return;
  std::fprintf(file, "%s", filter.type.c_str());
  for (const auto& [name, image] : filter.images)
    std::fprintf(file, " %s:%zux%zu+%zu,%zu,%zu:%d", name.c_str(), image.width, image.height, image.offset,
                 image.pixel_stride, image.row_stride, image.format);
  for (const auto& [name, value] : filter.bools)
    std::fprintf(file, " %s=%d", name.c_str(), value ? 1 : 0);
  for (const auto& [name, value] : filter.device->ints)
    std::fprintf(file, " %s=%d", name.c_str(), value);
  std::fprintf(file, " committed=%d%d\n", filter.device->committed ? 1 : 0, filter.committed ? 1 : 0);
  std::fclose(file);
}

} // namespace

extern "C" {

Device* oidnNewDevice(int type) {
  if (fault("no device") || type != 1) return nullptr;
  return new Device();
}

int oidnGetDeviceError(Device* device, const char** message) {
  if (device == nullptr) {
    *message = "SSE4.1 support is required at minimum";
    return 5;
  }
  device->told = device->message;
  *message = device->told.c_str();
  const int error = device->error;
  device->error = 0;
  device->message.clear();
  return error;
}

void oidnReleaseDevice(Device* device) {
  delete device;
}

void oidnCommitDevice(Device* device) {
  if (fault("crash")) std::abort();
  if (fault("commit")) fail(*device, 3, "the device is made of paper");
  device->committed = true;
}

Filter* oidnNewFilter(Device* device, const char* type) {
  return new Filter{device, type, {}, {}};
}

void oidnReleaseFilter(Filter* filter) {
  delete filter;
}

void oidnCommitFilter(Filter* filter) {
  filter->committed = true;
}

#ifdef FAKE_OIDN_1
void oidnSetDevice1i(Device* device, const char* name, int value) {
  device->ints[name] = value;
}
#else
void oidnSetDeviceInt(Device* device, const char* name, int value) {
  device->ints[name] = value;
}

void oidnSetDeviceBool(Device* device, const char* name, bool value) {
  device->ints[name] = value ? 1 : 0;
}

int oidnGetDeviceInt(Device*, const char* name) {
  if (std::strcmp(name, "versionMajor") == 0) return fault("old") ? 1 : 2;
  return std::strcmp(name, "versionMinor") == 0 ? 3 : 7;
}

void oidnSetSharedFilterImage(Filter* filter, const char* name, void* data, int format, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t pixel_stride,
                              std::size_t row_stride) {
  filter->images[name] = {static_cast<float*>(data), width, height, offset, pixel_stride, row_stride, format};
}

#ifndef FAKE_OIDN_LACKING
void oidnSetFilterBool(Filter* filter, const char* name, bool value) {
  filter->bools[name] = value;
}

void oidnExecuteFilter(Filter* filter) {
  const Image& output = filter->images["output"];
  if (fault("filter") || (fault("late") && output.width != 16)) return fail(*filter->device, 1, "the weights are gone");
  if (fault("memory") && output.width != 16) return fail(*filter->device, 4, "out of memory");
  log(*filter);
  const auto find = [&](const char* name) {
    const auto at = filter->images.find(name);
    return at == filter->images.end() ? nullptr : &at->second;
  };
  const Image *color = find("color"), *albedo = find("albedo"), *normal = find("normal");
  for (std::size_t y = 0; y < output.height; ++y)
    for (std::size_t x = 0; x < output.width; ++x)
      for (std::size_t k = 0; k < 3; ++k) {
        float value = 0.0f;
        if (color == nullptr)
          value = 0.5f * (albedo != nullptr ? albedo : normal)->at(x, y, k);
        else
          value = color->at(x, y, k) * (1.0f + albedo->at(x, y, k) + normal->at(x, y, k));
        output.at(x, y, k) = fault("nan") ? NAN : value;
      }
}
#endif
#endif
}
