#pragma once
#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace pointgi {

/// How long work will still take, by its pace since the first share that was done: what came before it, as the building
/// of kernels, does not come again.
class TimeLeft {
public:
  /// `share` done, 0..1, at `now` seconds; both ascend. Nothing before there is a pace to go by.
  std::optional<double> seconds(double share, double now);

private:
  std::optional<std::pair<double, double>> begun_; ///< the first share above 0, and when
};

/// Progress of one stage on stderr: a bar with elapsed and remaining time on a terminal, a plain line now and then
/// elsewhere, nothing when quiet.
class Progress {
public:
  Progress(std::string stage, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `share` done, 0..1.
  void update(double share);
  /// `done` so far, "12 applies", where nobody knows how much there will be.
  void tell(const std::string& done);
  /// Takes the bar off the terminal, until it is drawn again.
  void hide();

private:
  bool due();
  void draw(const std::string& line);

  std::string stage_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
  TimeLeft time_left_;
};

/// "0.4 s", "12 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

} // namespace pointgi
