#pragma once
#include "host/cl/session.h"

namespace pointgi::test {

/// One session for a whole test program: opening a device and building kernels are the slow part.
inline Session& session() {
  static Session one(choose_device(""));
  return one;
}

/// The device at hand, which says that it is a GPU.
inline Device faked_gpu() {
  Device device = choose_device("");
  device.info.is_cpu = false;
  device.info.is_gpu = true;
  return device;
}

/// A session of its own: programs are those of GPUs, and so are the shapes of launches.
inline Session& gpu_session() {
  static Session one(faked_gpu());
  return one;
}

} // namespace pointgi::test
