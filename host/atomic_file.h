#pragma once
/// Output files that are whole or absent: a reader, a crash or a full disk never meets half of one.
#include "host/error.h"
#include <cstddef>
#include <string>

namespace pointgi {

/// Error(output) for a failed system call on `path`: "<path>: cannot <action>: <strerror>; <remedy>".
/// `action` reads like "write the file"; `error_number` is the errno of the call.
Error output_error(const std::string& path, const std::string& action, int error_number);

/// A file under a temporary name in the folder of `final_path`, renamed over it by commit() and removed otherwise.
/// Until commit() returns an older file of that name stays whole. A symbolic link is followed, so that it goes on
/// pointing at the new content. Not to be shared between threads.
class AtomicFile {
public:
  /// Creates the temporary file, empty, open for reading and writing, with the permissions of the file it will replace
  /// or else those that the umask gives. Throws Error(output) when the folder is missing or not writable, or when
  /// `final_path` is something that a rename would destroy (a folder, a device) or that is write-protected.
  explicit AtomicFile(const std::string& final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Open until commit(). A library that wants a name may open temporary_path() as well, as long as it writes into that
  /// file and does not replace it.
  int fd() const { return fd_; }
  const std::string& temporary_path() const { return temporary_path_; }
  const std::string& final_path() const { return final_path_; }

  /// Writes `bytes` bytes at the end of what write() has put there. Throws Error(output), e.g. when the disk is full.
  void write(const void* data, std::size_t bytes);

  /// fsync, close, rename over final_path(), fsync of the folder. At most once. Everything written through other
  /// handles must have been flushed. Throws Error(output); the destructor then removes the temporary file.
  void commit();

  /// The same without fsync, for what can be made again: whole whatever becomes of the process, but a power cut may
  /// leave an empty or a torn file, which the reader has to tell.
  void commit_unsynced();

private:
  std::string final_path_;
  std::string target_path_; ///< final_path_ with symbolic links followed: what is renamed over
  std::string temporary_path_;
  int fd_ = -1;
  bool committed_ = false;
};

/// Removes what processes of this machine that are no more have left of an AtomicFile of this path. Throws as
/// AtomicFile on a link that leads nowhere.
void remove_unfinished(const std::string& final_path);

} // namespace pointgi
