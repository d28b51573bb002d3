#pragma once
/// Intel Open Image Denoise, found and loaded when it is asked for: nothing of it is needed to build or to start.
#include <cstddef>
#include <string>
#include <vector>

namespace pointgi {

/// What its handles point to is its own.
struct OidnDeviceObject;
struct OidnFilterObject;

/// Numbers of its C interface.
constexpr int oidn_cpu = 1;    ///< of device types
constexpr int oidn_float3 = 3; ///< of pixel formats
constexpr int oidn_no_error = 0, oidn_out_of_memory = 4;

/// The functions of its C interface, of version 2, that we call. Names of parameters are its own: "numThreads", "hdr".
struct OidnFunctions {
  OidnDeviceObject* (*new_device)(int type);
  void (*set_device_int)(OidnDeviceObject*, const char* name, int value);
  void (*set_device_bool)(OidnDeviceObject*, const char* name, bool value);
  int (*get_device_int)(OidnDeviceObject*, const char* name);
  /// The first error of this thread since the last call, which this one clears; of no device: of making one.
  int (*get_device_error)(OidnDeviceObject*, const char** message);
  void (*commit_device)(OidnDeviceObject*);
  void (*release_device)(OidnDeviceObject*);
  OidnFilterObject* (*new_filter)(OidnDeviceObject*, const char* type);
  /// Of an image that stays the caller's; offset and strides in bytes.
  void (*set_filter_image)(OidnFilterObject*, const char* name, void* data, int format, std::size_t width,
                           std::size_t height, std::size_t offset, std::size_t pixel_stride, std::size_t row_stride);
  void (*set_filter_bool)(OidnFilterObject*, const char* name, bool value);
  void (*commit_filter)(OidnFilterObject*);
  void (*execute_filter)(OidnFilterObject*);
  void (*release_filter)(OidnFilterObject*);
};

struct OidnLibrary {
  std::string file; ///< as the loader has it
  OidnFunctions functions;
};

/// Which files may be the library, the best first. `named`: what POINTGI_OIDN says, a file or the folder that holds it;
/// null or empty: names that the loader looks for in its usual places. Throws Error(usage) where what is named is not
/// there.
std::vector<std::string> oidn_candidates(const char* named);

/// Loads the library, by the variable POINTGI_OIDN of the environment if it is set; it stays loaded until the program
/// ends, as its threads do. Throws Error(usage) where there is none, or one that is damaged, lacks functions or is no
/// library; the text says where it was looked for and what to do. A library that crashes crashes this.
OidnLibrary load_oidn();

/// Why the file cannot be loaded: it is cut off, or no library of this kind of machine. Empty where nothing speaks
/// against it. A loader that is given a file which ends too early may crash.
std::string why_not_loadable(const std::string& file);

} // namespace pointgi
