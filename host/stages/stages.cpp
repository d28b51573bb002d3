#include "host/stages/stages.h"
#include "host/available_memory.h"
#include "host/run.h"
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace pointgi {

double StageLog::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void StageLog::start(const std::string& name) {
  begin_stage(name);
  release_freed_memory();
  StageRecord record;
  record.name = name;
  record.ran = true;
  record.start = seconds();
  records_.push_back(record);
}

void StageLog::finish(std::uint64_t items, const std::string& unit, double device_seconds) {
  StageRecord& record = records_.back();
  record.seconds = seconds() - record.start;
  record.device_seconds = device_seconds;
  record.host_peak_bytes = process_peak_bytes();
  record.items = items;
  record.unit = unit;
}

void StageLog::skip(const std::string& name, const std::string& reason) {
  StageRecord record;
  record.name = name;
  record.reason = reason;
  record.start = seconds();
  records_.push_back(record);
}

namespace {

nlohmann::json trace_event(const std::string& name, const char* category, int thread, double start_s, double seconds,
                           const nlohmann::json& arguments) {
  return {{"name", name},        {"cat", category},      {"ph", "X"},        {"pid", 1}, {"tid", thread},
          {"ts", 1e6 * start_s}, {"dur", 1e6 * seconds}, {"args", arguments}};
}

nlohmann::json thread_name(int thread, const char* name) {
  return {{"name", "thread_name"}, {"ph", "M"}, {"pid", 1}, {"tid", thread}, {"args", {{"name", name}}}};
}

/// Seconds since `begin` at which the host asked for a launch.
double called_at(const LaunchRecord& launch, std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(launch.called - begin).count();
}

/// Seconds to add to the device's clock to get those since `begin`. No launch starts before it was asked for: the one
/// that started soonest tells best. Ends tell less: while a band waits to be taken, the next one runs.
double clock_offset(const std::vector<LaunchRecord>& launches, std::chrono::steady_clock::time_point begin) {
  double offset = -std::numeric_limits<double>::infinity();
  for (const LaunchRecord& launch : launches)
    if (launch.has_clock)
      offset = std::max(offset, called_at(launch, begin) - 1e-9 * static_cast<double>(launch.start_ns));
  return offset;
}

} // namespace

std::string StageLog::chrome_trace(const std::vector<LaunchRecord>& launches) const {
  constexpr int host = 1, device = 2;
  nlohmann::json events = nlohmann::json::array({thread_name(host, "stages"), thread_name(device, "device")});
  for (const StageRecord& r : records_)
    if (r.ran)
      events.push_back(
          trace_event(r.name, "stage", host, r.start, r.seconds, {{r.unit.empty() ? "items" : r.unit, r.items}}));
  const double offset = clock_offset(launches, begin_);
  for (const LaunchRecord& launch : launches) {
    nlohmann::json arguments = nlohmann::json::object();
    if (!launch.label.empty()) arguments["variant"] = launch.label;
    const double start =
        launch.has_clock ? offset + 1e-9 * static_cast<double>(launch.start_ns) : called_at(launch, begin_);
    events.push_back(trace_event(launch.kernel, "kernel", device, start,
                                 1e-9 * static_cast<double>(launch.end_ns - launch.start_ns), arguments));
  }
  return nlohmann::json{{"traceEvents", events}, {"displayTimeUnit", "ms"}}.dump(1);
}

} // namespace pointgi
