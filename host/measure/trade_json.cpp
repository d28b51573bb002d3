#include "host/error.h"
#include "host/json_number.h"
#include "host/measure/trade.h"
#include "host/printable.h"
#include <fstream>
#include <limits>

namespace pointgi {

namespace {

using nlohmann::json;

json numbers(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values)
    list.push_back(json_number(value));
  return list;
}

json object_of(const Estimate& e) {
  return {{"value", json_number(e.value)}, {"low", json_number(e.low)}, {"high", json_number(e.high)}};
}

json object_of(const MeasuredRun& run) {
  json stages = json::object();
  for (const auto& [name, seconds] : run.stages)
    stages[name] = json_number(seconds);
  return {{"name", run.name},
          {"setting",
           {{"overrides", run.setting.overrides},
            {"knob", run.setting.knob},
            {"value", run.setting.value},
            {"method", run.setting.method}}},
          {"samples", run.samples},
          {"repeats", numbers(run.repeats)},
          {"seconds", object_of(run.seconds)},
          {"stages", stages},
          {"memory_bytes", run.memory_bytes},
          {"error", object_of(run.error)},
          {"noise", json_number(run.noise)},
          {"warm_seconds", json_number(run.warm_seconds)},
          {"bias", json_number(run.bias)},
          {"ssim", json_number(run.ssim)},
          {"picture", run.picture},
          {"on_front", run.on_front},
          {"refused", run.refused}};
}

json object_of(const KnobCurve& knob) {
  return {{"knob", knob.knob},   {"runs", knob.runs},     {"falls", knob.falls}, {"finding", knob.finding},
          {"about", knob.about}, {"values", knob.values}, {"own", knob.own}};
}

/// A place in the file that is read, by which errors name it: "runs.3.error".
class Reader {
public:
  Reader(const json& value, std::string place) : value_(value), place_(std::move(place)) {}

  Reader operator[](const char* key) const {
    require(value_.is_object(), "an object");
    const auto at = value_.find(key);
    if (at == value_.end()) throw Error(ErrorKind::input, place_ + ": has no \"" + key + "\"");
    return {*at, place_ + (place_.empty() || place_.back() == ' ' ? "" : ".") + key};
  }

  std::string text() const {
    require(value_.is_string(), "a text");
    return value_.get<std::string>();
  }
  bool flag() const {
    require(value_.is_boolean(), "true or false");
    return value_.get<bool>();
  }
  double number() const {
    if (value_.is_null()) return std::numeric_limits<double>::infinity();
    require(value_.is_number(), "a number");
    return value_.get<double>();
  }
  std::uint64_t count() const {
    require(value_.is_number_unsigned(), "a whole number that is not negative");
    return value_.get<std::uint64_t>();
  }
  int side() const {
    const std::uint64_t pixels = count();
    require(pixels >= 1 && pixels <= 65536, "a number of pixels from 1 to 65536");
    return static_cast<int>(pixels);
  }
  int samples() const {
    const std::uint64_t samples = count();
    require(samples >= 1 && samples <= 65536, "a number of samples from 1 to 65536");
    return static_cast<int>(samples);
  }
  Estimate estimate() const { return {(*this)["value"].number(), (*this)["low"].number(), (*this)["high"].number()}; }
  template <typename Of>
  auto list(const Of& of) const {
    require(value_.is_array(), "a list");
    std::vector<decltype(of(*this))> all;
    for (std::size_t i = 0; i < value_.size(); ++i)
      all.push_back(of(Reader(value_[i], place_ + "." + std::to_string(i))));
    return all;
  }
  std::vector<std::string> texts() const {
    return list([](const Reader& one) { return one.text(); });
  }
  std::map<std::string, double> by_name() const {
    require(value_.is_object(), "an object");
    std::map<std::string, double> all;
    for (const auto& [key, value] : value_.items())
      all[key] = Reader(value, place_ + "." + printable(key)).number();
    return all;
  }

private:
  void require(bool right, const char* expected) const {
    if (right) return;
    constexpr bool ascii = true; // fit for a terminal
    throw Error(ErrorKind::input,
                place_ + ": expected " + expected + ", found " + value_.dump(-1, ' ', ascii).substr(0, 40));
  }

  const json& value_;
  std::string place_;
};

MeasuredRun run_of(const Reader& in) {
  const Reader setting = in["setting"];
  MeasuredRun run;
  run.name = in["name"].text();
  run.setting = {setting["overrides"].texts(), setting["knob"].text(), setting["value"].text(),
                 setting["method"].text()};
  run.samples = in["samples"].samples();
  run.repeats = in["repeats"].list([](const Reader& one) { return one.number(); });
  run.seconds = in["seconds"].estimate();
  run.stages = in["stages"].by_name();
  run.memory_bytes = in["memory_bytes"].count();
  run.error = in["error"].estimate();
  run.noise = in["noise"].number();
  run.warm_seconds = in["warm_seconds"].number();
  run.bias = in["bias"].number();
  run.ssim = in["ssim"].number();
  run.picture = in["picture"].text();
  run.on_front = in["on_front"].flag();
  run.refused = in["refused"].text();
  return run;
}

KnobCurve knob_of(const Reader& in) {
  return {in["knob"].text(),  in["runs"].texts(),   in["falls"].flag(), in["finding"].text(),
          in["about"].text(), in["values"].texts(), in["own"].text()};
}

Trade trade_of(const Reader& in) {
  const Reader reference = in["reference"];
  Trade trade;
  trade.version = in["version"].text();
  trade.scene = in["scene"].text();
  trade.device = in["device"].text();
  trade.date = in["date"].text();
  trade.overrides = in["overrides"].texts();
  trade.state = in["state"].text();
  trade.width = in["width"].side();
  trade.height = in["height"].side();
  trade.full_width = in["full_width"].side();
  trade.full_height = in["full_height"].side();
  trade.budget_seconds = in["budget_seconds"].number();
  trade.spent_seconds = in["spent_seconds"].number();
  trade.prepare_seconds = in["prepare_seconds"].number();
  trade.reference = {reference["source"].text(), reference["picture"].text(), reference["own_noise"].number(),
                     reference["seconds"].number(), reference["file"].text()};
  trade.runs = in["runs"].list(run_of);
  trade.knobs = in["knobs"].list(knob_of);
  return trade;
}

} // namespace

std::string json_of(const Trade& trade) {
  json out = {{"version", trade.version},
              {"scene", trade.scene},
              {"device", trade.device},
              {"date", trade.date},
              {"overrides", trade.overrides},
              {"state", trade.state},
              {"width", trade.width},
              {"height", trade.height},
              {"full_width", trade.full_width},
              {"full_height", trade.full_height},
              {"budget_seconds", json_number(trade.budget_seconds)},
              {"spent_seconds", json_number(trade.spent_seconds)},
              {"prepare_seconds", json_number(trade.prepare_seconds)},
              {"reference",
               {{"source", trade.reference.source},
                {"picture", trade.reference.picture},
                {"own_noise", json_number(trade.reference.own_noise)},
                {"seconds", json_number(trade.reference.seconds)},
                {"file", trade.reference.file}}},
              {"runs", json::array()},
              {"knobs", json::array()}};
  for (const MeasuredRun& run : trade.runs)
    out["runs"].push_back(object_of(run));
  for (const KnobCurve& knob : trade.knobs)
    out["knobs"].push_back(object_of(knob));
  // What is no UTF-8, as a name of a file may be, becomes a mark instead of an error.
  return out.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Trade read_trade(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorKind::input, path + ": cannot be read; is it there?");
  // json_of() has seven levels, and the library takes one call within another for each when a value is shown.
  constexpr int most_levels = 32;
  const auto refuse_depth = [&](int levels, json::parse_event_t, const json&) {
    if (levels > most_levels)
      throw Error(ErrorKind::input, path + ": is no measurement: its lists and objects lie more than " +
                                        std::to_string(most_levels) + " deep in each other; remove it to measure anew");
    return true;
  };
  const json document = json::parse(file, refuse_depth, false);
  if (document.is_discarded())
    throw Error(ErrorKind::input, path + ": is no JSON, or was cut off; remove it to measure anew");
  return trade_of(Reader(document, path + ": "));
}

} // namespace pointgi
