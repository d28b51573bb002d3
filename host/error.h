#pragma once
/// Errors that a user sees: what was wrong, where, and what to do about it. They travel as exceptions and become an
/// exit code at one place (host/app/main.cpp).
#include <stdexcept>
#include <string>

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

/// The text is complete as it stands: "<where>: <what>, expected <...>; <remedy>".
class Error : public std::runtime_error {
public:
  Error(ExitCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
  ExitCode code() const noexcept { return code_; }

private:
  ExitCode code_;
};

} // namespace pointgi
