#include "host/api/parts.h"
#include "host/run.h"
#include "host/tune/self_test.h"

namespace pointgi::api {

namespace {

Device tested_device(const std::string& device, const RunControl& run) {
  const RunScope scope(run);
  return choose_tested_device(device);
}

} // namespace

Context::Context(const std::string& device, const RunControl& run)
    : parts_(new Parts{Session(tested_device(device, run)), StageLog()}) {}

const std::string& Context::device() const {
  return parts_->session.info().name;
}

std::vector<std::string> Context::devices() {
  std::vector<std::string> names;
  for (const Device& device : list_devices())
    names.push_back(device.info.name);
  return names;
}

} // namespace pointgi::api
