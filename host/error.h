#pragma once
/// Errors that a user sees: what was wrong, where, and what to do about it. They travel as exceptions; what they mean
/// to a shell is the command line's business (host/app/exit_code.h).
#include <stdexcept>
#include <string>

namespace pointgi {

/// Whose fault it is, and so who can mend it.
enum class ErrorKind {
  internal,    ///< a fault of the program
  usage,       ///< an option or argument
  input,       ///< a scene or cloud
  device,      ///< the OpenCL device or its driver
  output,      ///< a file that cannot be written
  memory,      ///< more than the host or the device has
  interrupted, ///< the caller asked to stop
};

/// What is wrong, and the remedy. what() is both, "<where>: <what>, expected <...>; <remedy>".
class Error : public std::runtime_error {
public:
  /// `text` is complete as it stands; the remedy, if it has one, stands behind its last "; ".
  Error(ErrorKind kind, const std::string& text) : std::runtime_error(text), kind_(kind) {}

  ErrorKind kind() const noexcept { return kind_; }

  /// What to do about it; empty where nobody knows.
  std::string remedy() const {
    const std::string text = what();
    const std::size_t at = text.rfind("; ");
    return at == std::string::npos ? std::string() : text.substr(at + 2);
  }

private:
  ErrorKind kind_;
};

} // namespace pointgi
