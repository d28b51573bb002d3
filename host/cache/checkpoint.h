#pragma once
/// Finished work of a run, kept beside its output, so that a run that was killed can go on where it was.
#include "host/cache/packed.h"
#include "octree/clock.h"
#include <functional>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace pointgi {

struct CheckpointOptions {
  std::string folder;               ///< made when the first work is kept
  std::function<std::string()> key; ///< everything that the work depends on, as text; asked once, before the first file
  double least_seconds = 10.0;      ///< work that took less is not kept; 0: all is
  bool resumes = false;             ///< what an earlier run of the same key has kept is used
  std::function<void(const std::string&)> warn; ///< from any thread; may be empty
};

/// A file for each piece of work, whole or absent. Where the folder cannot be written the run goes on without it, with
/// one warning; likewise where a run that still lives keeps its work there. Without `resumes`, what the folder holds
/// stays until the first work is kept, which then replaces it. Pieces may be kept and found on different threads.
class Checkpoint {
public:
  explicit Checkpoint(CheckpointOptions options);
  ~Checkpoint(); ///< what is kept stays; another run may take the folder
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  /// Makes the folder this run's until its end, with a file that it locks there; find and keep do so first. False,
  /// which is told once, where another run has it: nothing is kept or found then. Where the file system has no locks
  /// any run takes it.
  bool take_folder();

  /// "photon-2" of the second call with "photon": a run does the same work in the same order.
  std::string numbered(const std::string& name);

  /// The bytes that an earlier run has kept by this name; absent: it has not, or they are damaged.
  std::optional<std::string> find(const std::string& name);

  bool is_worth(double seconds) const { return seconds >= options_.least_seconds; }
  void keep(const std::string& name, const std::string& bytes);

  /// For pieces that take little each: kept once the last were kept least_seconds ago, or when many bytes wait. Of one
  /// name only the last piece is kept.
  void keep_soon(const std::string& name, std::string bytes);
  /// For a run that ends before its time: keeps what waits, unless all that the run has done took too little.
  void flush();

  /// From now on nothing is kept, which is told once: memory that pieces need is not there, say.
  void give_up(const std::string& why);

  /// The run is done: the folder goes, unless it holds another run's work alone.
  void remove();

  /// Whether an earlier run has left anything, of whatever key.
  /// `name`: that begins so.
  static bool is_in(const std::string& folder, const std::string& name = {});
  std::size_t found() const { return found_; } ///< pieces

private:
  std::string file_of(const std::string& name) const;
  bool take_locked();
  void let_go();
  const std::string& key();
  void clear();
  void write_locked(const std::string& name, const std::string& bytes);
  void flush_locked();
  void warn(const std::string& text) const;

  CheckpointOptions options_;
  std::mutex mutex_;
  std::optional<std::string> key_; ///< once it was asked for: a large scene takes seconds to tell
  std::map<std::string, unsigned> numbers_;
  std::map<std::string, std::string> waiting_;
  std::size_t waiting_bytes_ = 0;
  Clock::time_point kept_at_ = Clock::now();
  std::size_t found_ = 0;
  int lock_ = -1;        ///< file descriptor: as long as it is open, the folder is this run's
  bool refused_ = false; ///< another run has the folder
  bool begun_ = false;   ///< the folder holds nothing of other runs
  bool kept_ = false;    ///< something, in this run
  bool failed_ = false;  ///< and is left alone from then on
  bool foreign_ = false; ///< pieces of another key were met, and told
};

/// Makes `checkpoint` the one of this thread until its end; null: nothing is kept or found. It must live as long.
class CheckpointScope {
public:
  explicit CheckpointScope(Checkpoint* checkpoint);
  ~CheckpointScope();
  CheckpointScope(const CheckpointScope&) = delete;
  CheckpointScope& operator=(const CheckpointScope&) = delete;

private:
  Checkpoint* const outer_;
};

/// Of this thread; null: there is none.
Checkpoint* current_checkpoint();

/// What an earlier run has kept, or else what `make` returns, which is kept if it took long enough. `T` goes through
/// Packer and Unpacker by pack(Packer&, const T&) and unpack(Unpacker&, T&).
template <typename T, typename Make>
T kept_or_made(const std::string& name, const Make& make) {
  Checkpoint* const checkpoint = current_checkpoint();
  if (checkpoint == nullptr) return make();
  const std::string number = checkpoint->numbered(name);
  if (const std::optional<std::string> bytes = checkpoint->find(number)) {
    T kept;
    Unpacker from(*bytes);
    unpack(from, kept);
    if (from.is_whole()) return kept;
  }
  const Clock::time_point begun = Clock::now();
  T made = make();
  if (!checkpoint->is_worth(seconds_since(begun))) return made;
  try { // a piece in memory twice: what it is kept for must not fail for that
    Packer to;
    pack(to, made);
    checkpoint->keep(number, to.take());
  } catch (const std::bad_alloc&) {
    checkpoint->give_up("there is no memory for what would be kept of the work");
  }
  return made;
}

} // namespace pointgi
