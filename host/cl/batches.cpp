#include "host/cl/batches.h"

namespace pointgi {

void refuse_smallest(const ResourceError& error, std::size_t count) {
  throw ResourceError(error.kind(),
                      "a launch of " + std::to_string(count) +
                          " items is the smallest that keeps the device busy, and is refused: " + error.what());
}

} // namespace pointgi
