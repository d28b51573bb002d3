#pragma once
#include <cstdint>
#include <string>

namespace pointgi {

/// One OpenCL translation unit: the file (below kernels/, e.g. "render/shade.cl") with every `#include "..."` replaced
/// by that file's text, each file once, and `#line` markers so that messages of a device's compiler name our files.
/// -I options are not used: they do not travel to every driver. Files come from the binary, or from the folder that
/// POINTGI_KERNEL_DIR names. Throws Error(usage) when a file is missing there.
std::string kernel_source(const std::string& file);

/// The bare text of one file below kernels/ ("tuned/cpu.toml"), from the same two places.
std::string kernel_file(const std::string& name);

/// Of all files below kernels/, from the same two places: another number where any of them was changed.
std::uint64_t kernels_hash();

} // namespace pointgi
