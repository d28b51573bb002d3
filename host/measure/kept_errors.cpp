#include "host/measure/kept_errors.h"
#include "host/atomic_file.h"
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

namespace pointgi {

namespace {

using nlohmann::json;

/// The first `repeats` of what the file holds of a run.
std::optional<ErrorOfRepeats> errors_of(const json& kept, std::size_t repeats, const Trade& trade) {
  auto sums = kept.at("sums").get<std::vector<std::vector<double>>>();
  if (repeats == 0 || sums.size() < repeats) return std::nullopt;
  sums.resize(repeats);
  for (const std::vector<double>& one : sums)
    if (one.size() != ErrorOfRepeats::tiles(trade.width, trade.height)) return std::nullopt;
  return ErrorOfRepeats(trade.width, trade.height, std::move(sums), kept.at("deviation").get<double>());
}

} // namespace

void keep_errors(const ErrorsOfRuns& errors, const Trade& trade, const std::string& path) {
  json runs = json::object();
  for (const auto& [name, one] : errors)
    runs[name] = {{"deviation", one.deviation()}, {"sums", one.tile_sums()}};
  const std::vector<std::uint8_t> bytes =
      json::to_cbor({{"state", trade.state}, {"width", trade.width}, {"height", trade.height}, {"runs", runs}});
  AtomicFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

ErrorsOfRuns kept_errors(const std::string& path, const Trade& trade) {
  ErrorsOfRuns errors;
  std::ifstream file(path, std::ios::binary);
  try {
    const json kept = json::from_cbor(file);
    if (kept.at("state") != trade.state || kept.at("width") != trade.width || kept.at("height") != trade.height)
      return {};
    const json& runs = kept.at("runs");
    for (const MeasuredRun& run : trade.runs)
      if (const auto found = runs.find(run.name); found != runs.end())
        if (auto one = errors_of(*found, run.repeats.size(), trade)) errors.emplace(run.name, std::move(*one));
  } catch (const json::exception&) { // cut short, or no file of ours
    return {};
  }
  return errors;
}

} // namespace pointgi
