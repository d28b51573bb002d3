#pragma once
/// The run that this thread works for: its RunControl reaches every layer from here, as the functions on the way from a
/// stage down to a loop have no other use for it. Without a run, nothing stops the work and nobody hears of it.
#include "host/error.h"
#include "host/run_control.h"
#include <fmt/format.h>

namespace pointgi {

/// Makes `control` the one of this thread until its end; that of an outer run comes back then. The host's loops
/// (octree/parallel.h) end when it says so. `control` must live as long.
class RunScope {
public:
  explicit RunScope(const RunControl& control);
  ~RunScope();
  RunScope(const RunScope&) = delete;
  RunScope& operator=(const RunScope&) = delete;

private:
  friend void begin_stage(const std::string& name);
  friend void report_progress(double share);
  friend void report_progress(const std::string& done);
  friend bool stop_asked();
  friend Error interruption();
  friend void log_line(LogLevel level, const std::string& text);

  void tell(const StageProgress& progress) const;

  const RunControl& control_;
  RunScope* const outer_;
  std::string stage_;
};

/// From now on, progress and interruptions are those of this stage. Throws Error(interrupted) when stopping was asked
/// for.
void begin_stage(const std::string& name);

/// Of the stage that has begun: `share` done, 0..1.
void report_progress(double share);
/// `done` so far, "12 applies", where nobody knows how much there will be.
void report_progress(const std::string& done);

/// Whether the work should end.
bool stop_asked();
/// "interrupted in the stage ...".
Error interruption();
/// Throws interruption() when stopping was asked for.
void stop_if_asked();

void log_line(LogLevel level, const std::string& text);

template <typename... Args>
void log_debug(fmt::format_string<Args...> text, Args&&... args) {
  log_line(LogLevel::debug, fmt::format(text, std::forward<Args>(args)...));
}
template <typename... Args>
void log_info(fmt::format_string<Args...> text, Args&&... args) {
  log_line(LogLevel::info, fmt::format(text, std::forward<Args>(args)...));
}
template <typename... Args>
void log_warning(fmt::format_string<Args...> text, Args&&... args) {
  log_line(LogLevel::warning, fmt::format(text, std::forward<Args>(args)...));
}

} // namespace pointgi
