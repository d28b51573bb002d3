#pragma once
/// A device at work.
#include "host/run_control.h"
#include <memory>
#include <string>
#include <vector>

namespace pointgi::api {

/// Owns the device's queue, its compiled programs and their caches. It ends when the last object that was made with it
/// does. One thread at a time may use a context and what was made with it; different contexts are independent.
class Context {
public:
  /// `device`: an index of devices(), "cpu", "gpu", or a part of a name; empty: the GPU with the most memory that
  /// passes a test, else a CPU device; `run`'s log hears which GPUs did not pass. Compiled programs are kept in
  /// $POINTGI_CACHE_DIR, else ~/.cache/pointgi. Throws Error(device), whose text lists what there is, also where a
  /// device that was named does not pass.
  explicit Context(const std::string& device = {}, const RunControl& run = {});

  /// Name of the device.
  const std::string& device() const;

  /// Names of all OpenCL devices, in the order of their indices; empty when there is none.
  static std::vector<std::string> devices();

  struct Parts; ///< for the library itself
  const std::shared_ptr<Parts>& parts() const { return parts_; }

private:
  std::shared_ptr<Parts> parts_;
};

} // namespace pointgi::api
