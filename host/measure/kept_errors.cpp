#include "host/measure/kept_errors.h"
#include "host/atomic_file.h"
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace pointgi {

namespace {

using nlohmann::json;

/// Reads the head of an item: its major type, and the number that goes with it. False: of no kind that keep_errors()
/// writes, or cut short.
bool take_head(std::string_view& bytes, unsigned& major, std::uint64_t& argument) {
  if (bytes.empty()) return false;
  const auto first = static_cast<unsigned char>(bytes.front());
  bytes.remove_prefix(1);
  major = first >> 5;
  argument = first & 31;
  if (argument < 24) return true;
  if (argument > 27) return false; // without a length, which only some writers know
  const std::size_t size = std::size_t{1} << (argument - 24);
  if (bytes.size() < size) return false;
  argument = 0;
  for (const char byte : bytes.substr(0, size))
    argument = argument << 8 | static_cast<unsigned char>(byte);
  bytes.remove_prefix(size);
  return true;
}

/// Whether the bytes are numbers, texts, lists and objects as keep_errors() nests them. The library takes one call
/// within another for what lies in a list, an object or a text of parts, so that it is not given other bytes.
bool is_plain_cbor(std::string_view bytes) {
  constexpr unsigned byte_string = 2, text = 3, list = 4, object = 5, tag = 6;
  constexpr std::size_t most_levels = 8;
  std::vector<std::uint64_t> open{1}; // items still to come, of each level
  while (!open.empty()) {
    if (open.back() == 0) {
      open.pop_back();
      continue;
    }
    open.back() -= 1;
    unsigned major = 0;
    std::uint64_t argument = 0;
    if (!take_head(bytes, major, argument)) return false;
    if (major == text) {
      if (argument > bytes.size()) return false;
      bytes.remove_prefix(argument);
    } else if (major == list || major == object) {
      if (argument > bytes.size() || open.size() == most_levels) return false;
      open.push_back(major == object ? 2 * argument : argument);
    } else if (major == byte_string || major == tag) {
      return false;
    }
  }
  return bytes.empty();
}

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
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!is_plain_cbor(bytes)) return errors;
  try {
    const json kept = json::from_cbor(bytes);
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
