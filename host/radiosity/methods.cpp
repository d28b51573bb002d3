#include "host/radiosity/method.h"

namespace pointgi {

// Each in the file of its name.
extern const RadiosityMethod fmm_method, directions_method, gather_method, cones_method, direct_method;

const std::vector<const RadiosityMethod*>& radiosity_methods() {
  static const std::vector<const RadiosityMethod*> all{&fmm_method, &directions_method, &gather_method, &cones_method,
                                                       &direct_method};
  return all;
}

const RadiosityMethod* radiosity_method(const std::string& name) {
  for (const RadiosityMethod* method : radiosity_methods())
    if (name == method->name) return method;
  return nullptr;
}

} // namespace pointgi
