#pragma once
/// The stages of a run: which exist for this scene, what they did, how long they took. Names are those of the folders.
#include "host/cl/session.h"
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pointgi {

struct StageRecord {
  std::string name;
  bool ran = false;
  std::string reason; ///< why it did not run; empty when it did
  double start = 0.0; ///< seconds since the log began
  double seconds = 0.0;
  double device_seconds = 0.0;
  std::uint64_t host_peak_bytes = 0; ///< most that the process had held when the stage ended
  std::uint64_t items = 0;
  std::string unit; ///< of items: "points", "nodes", "rays", "pixels"
};

class StageLog {
public:
  StageLog() : begin_(std::chrono::steady_clock::now()) {}

  /// Opens a stage, which finish() closes. Throws Error(interrupted) when the run (host/run.h) is to stop.
  void start(const std::string& name);
  void finish(std::uint64_t items, const std::string& unit, double device_seconds = 0.0);
  void skip(const std::string& name, const std::string& reason);

  const std::vector<StageRecord>& records() const { return records_; }
  double seconds() const; ///< since the log began

  /// The stages, and below them the launches of a session that recorded them, as a Chrome trace (chrome://tracing,
  /// Perfetto).
  std::string chrome_trace(const std::vector<LaunchRecord>& launches) const;

private:
  std::chrono::steady_clock::time_point begin_;
  std::vector<StageRecord> records_;
};

/// While one lives, what is done is logged apart, and not in the log that it was made of.
class StagesApart {
public:
  explicit StagesApart(StageLog& log) : log_(log), before_(std::exchange(log, StageLog())) {}
  ~StagesApart() { log_ = std::move(before_); }
  StagesApart(const StagesApart&) = delete;
  StagesApart& operator=(const StagesApart&) = delete;

  const StageLog& before() const { return before_; }

private:
  StageLog& log_;
  StageLog before_;
};

} // namespace pointgi
