#pragma once
/// Runs of the program in which a call fails (tests/fakes/faults), and what each must keep: the right picture or one
/// clear error, old files or whole new ones, nothing left behind.
#include "tests/support/run_program.h"
#include <map>
#include <vector>

namespace pointgi::test {

/// As the code of a system call: the program is killed in it.
constexpr int kill_there = -9;

/// Which call fails; as in tests/fakes/faults/fault.h.
struct Fault {
  std::string call;
  std::string at; ///< its number, from 1; of an allocation its place
  int code = 0;
  bool lasts = false;

  std::string text() const;
};

/// What goes before the program, and before variables that say which call fails: loads the library of faults.
std::string with_faults();

/// What a run with the library of faults told of its calls.
struct CallReport {
  bool is_there = false; ///< not of a run that crashed
  std::map<std::string, std::size_t> counts;
  std::map<std::string, std::size_t> largest;   ///< bytes of a call
  std::map<std::string, long> live;             ///< objects and blocks that were not given back
  std::vector<std::string> places;              ///< of allocations
  std::map<std::string, std::string> addresses; ///< of a place, in the program, for addr2line
  std::size_t struck = 0;                       ///< calls that failed
};

enum class Outcome {
  right_picture, ///< the call failed, and the picture is the one of an undisturbed run
  clear_error,   ///< one message with a remedy, and an exit code of its own
  killed,        ///< as was wanted, and its files are old ones or whole new ones
  not_met,       ///< the call never came
  broken,
};

struct Judgement {
  Outcome outcome = Outcome::broken;
  std::string finding; ///< what is broken
};

/// A scene with all stages, rendered without a fault once, and again and again with one.
class FaultScene {
public:
  struct Way {
    std::string name;
    std::string options;      ///< of render
    std::string variables;    ///< "NAME=VALUE " of the environment
    bool keeps_cache = false; ///< the cache of one run is that of the next; else each begins with an empty one
  };
  /// Runs it undisturbed, which compiles what the driver has not compiled before. Throws std::runtime_error where that
  /// fails.
  explicit FaultScene(const Way& way);

  const Way& way() const { return way_; }
  /// Of the undisturbed run.
  const CallReport& calls() const { return calls_; }
  /// Runs it with the fault. Runs of different `slot`s may go on at a time.
  Judgement judge(const Fault& fault, int slot = 0) const;
  /// Runs it undisturbed on what the faults of this slot left; `variables` as in Way. Empty, or what is broken.
  std::string undisturbed(const std::string& variables = "", int slot = 0) const;
  /// The same, with all that the run said, and unjudged.
  Run run(const std::string& variables, const std::string& options, int slot, CallReport& report) const;

  /// What the last run of the slot wrote: "a.exr", "a.png", "stats.json", "trace.json".
  std::string output(const std::string& name, int slot = 0) const { return folder_of(slot) + "/out/" + name; }

private:
  std::string folder_of(int slot) const;
  void put_old_files(int slot) const;
  std::string wrong_file(int slot, bool finished, bool may_leave_temporary) const;
  std::string wrong_cache(int slot, bool may_leave_temporary) const;

  Way way_;
  TemporaryFolder folder_;
  CallReport calls_;
  std::map<std::string, std::vector<float>> channels_; ///< of the undisturbed picture
  std::string png_, vmap_;
  int limit_seconds_ = 0; ///< of a run
};

/// The ways that together call all that is called: links and a V-map; directions; images; the cache of programs.
FaultScene::Way fmm_way();
FaultScene::Way directions_way();
FaultScene::Way images_way();
FaultScene::Way cached_programs_way();

} // namespace pointgi::test
