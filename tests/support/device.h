#pragma once
#include "host/cl/session.h"

namespace pointgi::test {

/// One session for a whole test program: opening a device and building kernels are the slow part.
inline Session& session() {
  static Session one(choose_device(""));
  return one;
}

} // namespace pointgi::test
