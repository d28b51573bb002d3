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

} // namespace

void require_regular_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw cannot_read(path, errno);
  refuse_unless_regular(path, status);
}

// The first look is before opening (opening a device can have effects), the second after (the name may have changed
// hands); O_NONBLOCK keeps a pipe from blocking in between.
InputFile::InputFile(const std::string& path) : path_(path) {
  require_regular_file(path);
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd_ < 0) throw cannot_read(path, errno);
  struct stat status {};
  try {
    if (::fstat(fd_, &status) != 0) throw cannot_read(path, errno);
    refuse_unless_regular(path, status);
  } catch (...) {
    ::close(fd_);
    throw;
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  ::close(fd_);
}

void InputFile::read(std::uint64_t offset, void* to, std::size_t bytes) const {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t got = ::pread(fd_, static_cast<char*>(to) + done, std::min<std::size_t>(bytes - done, 1u << 30),
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw cannot_read(path_, errno);
    if (got == 0)
      throw Error(ErrorKind::input, path_ + ": became shorter while it was read (at byte " +
                                        std::to_string(offset + done) + "); wait until it has been written");
    done += static_cast<std::size_t>(got);
  }
}

FileBytes read_whole_file(const std::string& path) {
  const InputFile file(path);
  FileBytes bytes;
  bytes.size = static_cast<std::size_t>(file.size());
  bytes.data.reset(new (std::nothrow) char[std::max<std::size_t>(bytes.size, 1)]);
  if (!bytes.data)
    throw Error(ErrorKind::memory, path + ": " + std::to_string(bytes.size) +
                                       " bytes do not fit into memory; thin the cloud out or split it");
  file.read(0, bytes.data.get(), bytes.size);
  return bytes;
}

bool has_extension(const std::string& path, std::string_view extension) {
  return path.size() >= extension.size() &&
         std::equal(extension.rbegin(), extension.rend(), path.rbegin(),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

} // namespace pointgi
