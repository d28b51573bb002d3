#pragma once
#include "host/error.h"

namespace pointgi {

/// The device refused an allocation or a launch for want of memory or other resources. Nothing was run, so that the
/// same work may be tried again in smaller pieces.
class ResourceError : public Error {
public:
  using Error::Error;
};

} // namespace pointgi
