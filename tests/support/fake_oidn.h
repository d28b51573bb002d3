#pragma once
/// Stand-ins for Open Image Denoise, which are built beside the program (tests/fakes/oidn.cpp).
#include "tests/support/environment.h"
#include <filesystem>

namespace pointgi::test {

/// The folder of one: "works", "lacking" (two functions), "version1".
inline std::string fake_oidn(const std::string& kind) {
  return (std::filesystem::path(POINTGI_BINARY).parent_path() / "fakes" / kind).string();
}

/// The one that works is what the program finds, until the end of the scope. `fault`: its fault, or null.
struct FakeOidn {
  explicit FakeOidn(const char* fault = nullptr)
      : library("POINTGI_OIDN", fake_oidn("works").c_str()), fault_of("FAKE_OIDN", fault) {}
  Variable library, fault_of;
};

} // namespace pointgi::test
