#pragma once
/// The filter of Intel Open Image Denoise on the CPU.
#include "host/denoise/oidn_library.h"
#include <memory>

namespace pointgi {

/// Images of one size, [height x width x 3], rows downwards. Null: not given.
struct DenoiseImages {
  int width = 0, height = 0;
  const float* light = nullptr;  ///< radiance, 0 or more
  const float* albedo = nullptr; ///< 0 to 1
  const float* normal = nullptr; ///< -1 to 1
  bool clean = false;            ///< albedo and normal have no noise
  float* output = nullptr;       ///< the denoised light; without light, the only one of albedo and normal; may be it
};

class Denoiser {
public:
  /// Loads the library and makes its device of `threads` threads. Throws Error(usage) as load_oidn() does, and where
  /// the library is too old or makes no device.
  explicit Denoiser(int threads);

  /// Throws Error: memory where the library has too little, else device, with what the library says.
  void filter(const DenoiseImages& images) const;

  const std::string& file() const { return library_.file; }
  const std::string& version() const { return version_; } ///< "2.3.3"

private:
  OidnLibrary library_;
  std::unique_ptr<OidnDeviceObject, void (*)(OidnDeviceObject*)> device_;
  std::string version_;
};

/// Tries all of it on a small picture, in a process of its own: where the library crashes, that process ends, and this
/// one throws Error(usage). To be called before the program has threads. Throws as Denoiser and filter().
void try_denoiser();

} // namespace pointgi
