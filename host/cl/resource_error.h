#pragma once
#include "host/error.h"
#include <cstdint>
#include <string>

namespace pointgi {

/// The device refused an allocation or a launch for want of memory or other resources. Nothing was run, so that the
/// same work may be tried again in smaller pieces.
class ResourceError : public Error {
public:
  using Error::Error;
};

/// "12 MiB", rounded up.
inline std::string megabytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

} // namespace pointgi
