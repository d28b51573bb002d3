#pragma once
#include "host/error.h"

namespace pointgi {

/// What the program returns to the shell; part of the interface.
enum class ExitCode : int {
  done = 0,
  internal = 1,
  usage = 2,
  input = 3, ///< bad scene or cloud
  device = 4,
  output = 5,
  memory = 6,
  interrupted = 130,
};

constexpr ExitCode exit_code_of(ErrorKind kind) {
  switch (kind) {
  case ErrorKind::usage:
    return ExitCode::usage;
  case ErrorKind::input:
    return ExitCode::input;
  case ErrorKind::device:
    return ExitCode::device;
  case ErrorKind::output:
    return ExitCode::output;
  case ErrorKind::memory:
    return ExitCode::memory;
  case ErrorKind::interrupted:
    return ExitCode::interrupted;
  case ErrorKind::internal:
    break;
  }
  return ExitCode::internal;
}

} // namespace pointgi
