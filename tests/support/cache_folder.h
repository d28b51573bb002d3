#pragma once
#include "tests/support/temporary_folder.h"
#include <cstdlib>
#include <optional>
#include <string>

namespace pointgi::test {

/// POINTGI_CACHE_DIR is this folder for a while.
class CacheFolder {
public:
  CacheFolder() {
    if (const char* old = std::getenv("POINTGI_CACHE_DIR")) old_ = old;
    setenv("POINTGI_CACHE_DIR", folder_.file("cache").c_str(), 1);
  }
  ~CacheFolder() {
    if (old_)
      setenv("POINTGI_CACHE_DIR", old_->c_str(), 1);
    else
      unsetenv("POINTGI_CACHE_DIR");
  }

private:
  TemporaryFolder folder_;
  std::optional<std::string> old_;
};

} // namespace pointgi::test
