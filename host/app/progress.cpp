#include "host/app/progress.h"
#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace pointgi {

namespace {

double seconds_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

/// A line now and then, for logs that are read later.
constexpr double plain_interval = 5.0;
constexpr double bar_interval = 0.1;
constexpr int bar_width = 30;

/// The pace of less time, or of a smaller share, is chance.
constexpr double seconds_to_go_by = 0.2, share_to_go_by = 0.002;

} // namespace

std::string duration_text(double seconds) {
  char text[64];
  const long whole = static_cast<long>(seconds + 0.5);
  if (seconds < 9.95)
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  else if (whole < 60)
    std::snprintf(text, sizeof text, "%ld s", whole);
  else if (whole < 3600)
    std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  return text;
}

Progress::Progress(std::string stage, bool quiet)
    : stage_(std::move(stage)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()), last_(start_) {}

Progress::~Progress() {
  hide();
}

void Progress::hide() {
  if (drawn_ && terminal_) std::fprintf(stderr, "\r\033[K");
  drawn_ = false;
}

bool Progress::due() {
  if (quiet_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (seconds_between(last_, now) < (terminal_ ? bar_interval : plain_interval)) return false;
  last_ = now;
  return true;
}

void Progress::draw(const std::string& line) {
  drawn_ = true;
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
}

std::optional<double> TimeLeft::seconds(double share, double now) {
  if (share <= 0.0) return std::nullopt;
  if (!begun_) begun_ = {share, now};
  const double done = share - begun_->first, took = now - begun_->second;
  if (done < share_to_go_by || took < seconds_to_go_by) return std::nullopt;
  return took * (1.0 - share) / done;
}

void Progress::update(double share) {
  const double now = seconds_between(start_, std::chrono::steady_clock::now());
  const std::optional<double> left = time_left_.seconds(share, now);
  if (!due()) return;
  const double elapsed = seconds_between(start_, last_), done = std::clamp(share, 1e-6, 1.0);
  std::string times = duration_text(elapsed) + " elapsed";
  if (left) times += ", " + duration_text(*left) + " remaining";
  const int percent = static_cast<int>(100.0 * done);
  if (!terminal_) {
    draw(stage_ + ": " + std::to_string(percent) + " %, " + times);
    return;
  }
  const auto filled = static_cast<std::size_t>(bar_width * done);
  char number[16];
  std::snprintf(number, sizeof number, "%3d %%  ", percent);
  draw(stage_ + " [" + std::string(filled, '#') + std::string(bar_width - filled, ' ') + "] " + number + times);
}

void Progress::tell(const std::string& done) {
  if (due()) draw(stage_ + ": " + done + ", " + duration_text(seconds_between(start_, last_)) + " elapsed");
}

} // namespace pointgi
