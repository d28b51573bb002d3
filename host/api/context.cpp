#include "host/api/parts.h"
#include "host/tune/self_test.h"

namespace pointgi::api {

Context::Context(const std::string& device) : parts_(new Parts{Session(choose_tested_device(device)), StageLog()}) {}

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
