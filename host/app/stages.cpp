#include "host/app/stages.h"
#include <nlohmann/json.hpp>

namespace pointgi {

double StageLog::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void StageLog::start(const std::string& name) {
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

std::string StageLog::chrome_trace() const {
  nlohmann::json events = nlohmann::json::array();
  for (const StageRecord& record : records_)
    if (record.ran)
      events.push_back({{"name", record.name},
                        {"cat", "stage"},
                        {"ph", "X"},
                        {"pid", 1},
                        {"tid", 1},
                        {"ts", 1e6 * record.start},
                        {"dur", 1e6 * record.seconds},
                        {"args", {{record.unit.empty() ? "items" : record.unit, record.items}}}});
  return nlohmann::json{{"traceEvents", events}, {"displayTimeUnit", "ms"}}.dump(1);
}

} // namespace pointgi
