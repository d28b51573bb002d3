#include "host/atomic_file.h"
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <random>
#include <sys/stat.h>
#include <unistd.h>

namespace pointgi {

namespace fs = std::filesystem;

namespace {

const char* remedy_for(int error_number) {
  switch (error_number) {
  case ENOENT:
  case ENOTDIR:
    return "create the folder first or choose another one";
  case EACCES:
  case EPERM:
  case EROFS:
    return "choose a folder that you may write to";
  case ENOSPC:
  case EDQUOT:
    return "free some space or choose a folder on another disk";
  case EFBIG:
    return "the file is larger than the disk or `ulimit -f` allows: choose another disk or raise the limit";
  case ENAMETOOLONG:
    return "choose a shorter name";
  case EISDIR:
    return "choose the name of a file";
  default:
    return "check the folder and the disk";
  }
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// Where the bytes will end up: `path`, or what it points at when it is a symbolic link.
std::string follow_link(const std::string& path) {
  std::error_code failed;
  if (!fs::is_symlink(fs::symlink_status(path, failed))) return path;
  const fs::path target = fs::canonical(path, failed);
  if (failed) throw output_error(path, "follow the symbolic link", failed.value());
  return target.string();
}

/// What the names of temporary files of a target begin with. A name may have 255 bytes: it leaves room for the suffix.
std::string temporary_prefix(const std::string& target) {
  return "." + fs::path(target).filename().string().substr(0, 180) + ".";
}

/// A hidden name beside `target` that no other run is likely to choose; O_EXCL settles the rest.
std::string temporary_name(const std::string& target) {
  static thread_local std::random_device entropy;
  char suffix[64];
  std::snprintf(suffix, sizeof suffix, "%ld.%08x.tmp", static_cast<long>(getpid()), entropy());
  return (fs::path(folder_of(target)) / (temporary_prefix(target) + suffix)).string();
}

} // namespace

Error output_error(const std::string& path, const std::string& action, int error_number) {
  return Error(ErrorKind::output,
               path + ": cannot " + action + ": " + std::strerror(error_number) + "; " + remedy_for(error_number));
}

AtomicFile::AtomicFile(const std::string& final_path) : final_path_(final_path) {
  if (final_path.empty() || final_path.back() == '/')
    throw Error(ErrorKind::output, "\"" + final_path + "\": not the name of a file; give one like out/picture.exr");
  target_path_ = follow_link(final_path);

  struct stat old {};
  const bool replaces = ::stat(target_path_.c_str(), &old) == 0;
  if (!replaces && errno != ENOENT) throw output_error(final_path, "write the file", errno);
  if (replaces && S_ISDIR(old.st_mode)) throw output_error(final_path, "write the file", EISDIR);
  // As root a rename would put a plain file in the place of /dev/null.
  if (replaces && !S_ISREG(old.st_mode))
    throw Error(ErrorKind::output, final_path + ": is a device or a pipe, which cannot be written safely; "
                                                "choose the name of a regular file");
  if (replaces) { // a rename asks the folder only; opening asks the file
    const int old_file = ::open(target_path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (old_file < 0)
      throw Error(ErrorKind::output, final_path + ": is write-protected; choose another name or run `chmod u+w` on it");
    ::close(old_file);
  }

  // Some tens of attempts: a collision of 32 random bits in one process id is already a curiosity.
  for (int attempt = 0; attempt < 32 && fd_ < 0; ++attempt) {
    temporary_path_ = temporary_name(target_path_);
    fd_ = ::open(temporary_path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno != EEXIST) break;
  }
  if (fd_ < 0) throw output_error(final_path, "create a file in the folder \"" + folder_of(target_path_) + "\"", errno);
  // Best effort: the owner may be somebody else, and then the umask's permissions are right.
  if (replaces) (void)::fchmod(fd_, old.st_mode & 0777);
}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!committed_) ::unlink(temporary_path_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(fd_, from, std::min<std::size_t>(bytes, 1u << 30));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw output_error(final_path_, "write the file", written == 0 ? ENOSPC : errno);
    from += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::commit() {
  // Data must be on the disk before the name points at them, else a power cut leaves an empty file.
  if (!committed_ && ::fsync(fd_) != 0) throw output_error(final_path_, "write the file to the disk", errno);
  commit_unsynced();
  // The rename itself becomes durable with the folder. Some file systems refuse this; the file is whole either way.
  const int folder = ::open(folder_of(target_path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    (void)::fsync(folder);
    ::close(folder);
  }
}

void AtomicFile::commit_unsynced() {
  if (committed_) throw Error(ErrorKind::internal, final_path_ + ": committed twice");
  const int closing = fd_;
  fd_ = -1;
  if (::close(closing) != 0) throw output_error(final_path_, "close the file", errno);
  if (::rename(temporary_path_.c_str(), target_path_.c_str()) != 0)
    throw output_error(final_path_, "rename the finished file", errno);
  committed_ = true;
}

void remove_unfinished(const std::string& final_path) {
  const std::string target = follow_link(final_path), prefix = temporary_prefix(target);
  const std::size_t name_size = fs::path(target).filename().string().size();
  if (prefix.size() != name_size + 2) return; // names that were cut may be another file's
  std::error_code ignored;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder_of(target), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(prefix, 0) != 0) continue;
    long process = 0;
    unsigned number = 0;
    int end = 0;
    const std::string rest = name.substr(prefix.size()); // "<process>.<8 digits>.tmp"
    if (std::sscanf(rest.c_str(), "%ld.%8x.tmp%n", &process, &number, &end) != 2 ||
        end != static_cast<int>(rest.size()) || process <= 0)
      continue;
    const bool lives = ::kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH;
    if (!lives) left.push_back(entry.path());
  }
  for (const fs::path& file : left)
    fs::remove(file, ignored);
}

} // namespace pointgi
