/// Calls to the file system that the program makes itself, or the standard library for it; a driver's own are let be.
#include "tests/fakes/faults/fault.h"
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

/// Whether this call fails with the errno that is then set.
bool fails(faults::Call& call) {
  if (!faults::is_running() || !faults::called_by_program() || !faults::strikes(call)) return false;
  if (faults::code() == -SIGKILL) raise(SIGKILL);
  errno = faults::code();
  return true;
}

/// Bytes that are left to be written or read of `bytes`: half of them where a call is cut short.
std::size_t cut(std::size_t bytes) {
  return bytes > 1 ? bytes / 2 : bytes;
}

} // namespace

// A function with its arguments as they are, whose failure is -1.
#define FAILING(type, name, parameters, arguments)                                                                     \
  type name parameters {                                                                                               \
    static faults::Call call(#name);                                                                                   \
    static auto* const next = faults::real<type parameters>(#name);                                                    \
    return fails(call) ? static_cast<type>(-1) : next arguments;                                                       \
  }
// One that moves bytes: code 0 is a call that moves half of them.
#define MOVING(name, data, more_parameters, ...)                                                                       \
  ssize_t name(int file, data bytes, std::size_t count more_parameters) {                                              \
    static faults::Call call(#name);                                                                                   \
    static auto* const next = faults::real<ssize_t(int, data, std::size_t more_parameters)>(#name);                    \
    if (!fails(call)) return next(file, bytes, count __VA_ARGS__);                                                     \
    return faults::code() == 0 ? next(file, bytes, cut(count) __VA_ARGS__) : -1;                                       \
  }
#define COMMA ,

extern "C" {
MOVING(write, const void*, , )
MOVING(read, void*, , )
MOVING(pwrite, const void*, COMMA off_t at, COMMA at)
MOVING(pread, void*, COMMA off_t at, COMMA at)
FAILING(ssize_t, writev, (int file, const iovec* parts, int count), (file, parts, count))
FAILING(int, fsync, (int file), (file))
FAILING(int, rename, (const char* from, const char* to) noexcept, (from, to))
FAILING(int, mkdir, (const char* path, mode_t mode) noexcept, (path, mode))
FAILING(int, stat, (const char* path, struct stat* found) noexcept, (path, found))
FAILING(int, fstat, (int file, struct stat* found) noexcept, (file, found))

/// As where the disk is found full only when the file is closed: it is closed all the same.
int close(int file) {
  static faults::Call call("close");
  static auto* const next = faults::real<int(int)>("close");
  const bool is_struck = fails(call);
  const int reason = errno, result = next(file);
  if (!is_struck) return result;
  errno = reason;
  return -1;
}

int open(const char* path, int flags, ...) {
  static faults::Call call("open");
  static auto* const next = faults::real<int(const char*, int, ...)>("open");
  mode_t mode = 0;
  if ((flags & (O_CREAT | O_TMPFILE)) != 0) {
    va_list more;
    va_start(more, flags);
    mode = va_arg(more, mode_t);
    va_end(more);
  }
  return fails(call) ? -1 : next(path, flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  static faults::Call call("fopen");
  static auto* const next = faults::real<FILE*(const char*, const char*)>("fopen64");
  return fails(call) ? nullptr : next(path, mode);
}
FILE* fopen(const char* path, const char* mode) {
  return fopen64(path, mode);
}
}
