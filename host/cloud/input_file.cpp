#include "host/cloud/input_file.h"
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <sys/stat.h>
#include <unistd.h>

namespace pointgi {

namespace {

Error cannot_read(const std::string& path, int error_number) {
  const char* remedy = error_number == EACCES ? "make it readable for you (chmod u+r)"
                       : error_number == ENOENT
                           ? "check its name; relative names start at the working directory, or at "
                             "the scene file's folder when a scene names them"
                           : "check the path and the disk";
  return Error(ErrorKind::input, path + ": cannot read the file: " + std::strerror(error_number) + "; " + remedy);
}

void refuse_unless_regular(const std::string& path, const struct stat& status) {
  if (S_ISREG(status.st_mode)) return;
  const char* kind = S_ISDIR(status.st_mode)    ? "a folder"
                     : S_ISFIFO(status.st_mode) ? "a pipe"
                     : S_ISSOCK(status.st_mode) ? "a socket"
                                                : "a device";
  throw Error(ErrorKind::input,
              path + ": is " + kind + ", expected a regular file" +
                  (S_ISDIR(status.st_mode) ? "; name a file in it" : "; save the data to a file first"));
}

/// Closes on every way out.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

} // namespace

void require_regular_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw cannot_read(path, errno);
  refuse_unless_regular(path, status);
}

FileBytes read_whole_file(const std::string& path) {
  // The first look is before opening (opening a device can have effects), the second after (the name may have changed
  // hands); O_NONBLOCK keeps a pipe from blocking in between.
  require_regular_file(path);
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat status {};
  if (file.fd < 0 || ::fstat(file.fd, &status) != 0) throw cannot_read(path, errno);
  refuse_unless_regular(path, status);

  FileBytes bytes;
  bytes.size = static_cast<std::size_t>(status.st_size);
  bytes.data.reset(new (std::nothrow) char[std::max<std::size_t>(bytes.size, 1)]);
  if (!bytes.data)
    throw Error(ErrorKind::memory, path + ": " + std::to_string(bytes.size) +
                                       " bytes do not fit into memory; thin the cloud out or split it");
  std::size_t done = 0;
  while (done < bytes.size) {
    const ssize_t got = ::read(file.fd, bytes.data.get() + done, std::min<std::size_t>(bytes.size - done, 1u << 30));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw cannot_read(path, errno);
    if (got == 0)
      throw Error(ErrorKind::input, path + ": became shorter while it was read (at byte " + std::to_string(done) +
                                        "); wait until it has been written");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::string printable(std::string_view text, std::size_t max_bytes) {
  static const char digits[] = "0123456789abcdef";
  std::string out;
  for (const char c : text.substr(0, max_bytes)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && c != '"' && c != '\\') {
      out += c;
    } else {
      out += "\\x";
      out += digits[byte >> 4];
      out += digits[byte & 15];
    }
  }
  if (text.size() > max_bytes) out += "...";
  return out;
}

std::string quoted_bytes(std::string_view text, std::size_t max_bytes) {
  return '"' + printable(text, max_bytes) + '"';
}

bool has_extension(const std::string& path, std::string_view extension) {
  return path.size() >= extension.size() &&
         std::equal(extension.rbegin(), extension.rend(), path.rbegin(),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

} // namespace pointgi
