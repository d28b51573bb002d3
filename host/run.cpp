#include "host/run.h"
#include "octree/parallel.h"

namespace pointgi {

namespace {

thread_local RunScope* current = nullptr;

/// The loops of this thread ask as often as they take a range.
void let_loops_ask() {
  before_ranges(current != nullptr ? &stop_if_asked : nullptr);
}

} // namespace

RunScope::RunScope(const RunControl& control) : control_(control), outer_(current) {
  current = this;
  let_loops_ask();
}

RunScope::~RunScope() {
  current = outer_;
  let_loops_ask();
}

void RunScope::tell(const StageProgress& progress) const {
  if (control_.progress) control_.progress(progress);
}

void begin_stage(const std::string& name) {
  if (current == nullptr) return;
  current->stage_ = name;
  stop_if_asked();
  current->tell({name, {}, {}});
}

void report_progress(double share) {
  if (current != nullptr) current->tell({current->stage_, share, {}});
}

void report_progress(const std::string& done) {
  if (current != nullptr) current->tell({current->stage_, {}, done});
}

bool stop_asked() {
  return current != nullptr && current->control_.stop && current->control_.stop();
}

Error interruption() {
  const std::string stage = current != nullptr && !current->stage_.empty() ? " in the stage " + current->stage_ : "";
  return Error(ErrorKind::interrupted, "interrupted" + stage + "; nothing was written");
}

void stop_if_asked() {
  if (stop_asked()) throw interruption();
}

void log_line(LogLevel level, const std::string& text) {
  if (current != nullptr && current->control_.log) current->control_.log(level, text);
}

} // namespace pointgi
