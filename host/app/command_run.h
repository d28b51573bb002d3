#pragma once
/// A run as the command line has it: Ctrl-C ends it, its progress is drawn, its log goes to stderr.
#include "host/app/progress.h"
#include "host/run.h"
#include <optional>

namespace pointgi {

/// From its construction on, Ctrl-C and SIGTERM ask this thread's work to end, once.
class CommandRun {
public:
  explicit CommandRun(bool quiet);
  CommandRun(const CommandRun&) = delete;
  CommandRun& operator=(const CommandRun&) = delete;

  const RunControl& control() const { return control_; }
  /// Takes the bar off the terminal: before results are printed.
  void end_progress() { progress_.reset(); }

private:
  void show(const StageProgress& news);

  bool quiet_;
  std::optional<Progress> progress_; ///< of the stage that runs
  RunControl control_;
  RunScope scope_;
};

/// The log's way to stderr.
void write_log(LogLevel level, const std::string& text);

} // namespace pointgi
