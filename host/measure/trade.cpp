#include "host/measure/trade.h"
#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace pointgi {

namespace {

/// As a shell takes it for one word.
std::string shell_word(const std::string& text) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text)
    word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// As a field of a CSV file (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text)
    field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

template <typename Better>
std::optional<std::size_t> best(const Trade& trade, const Better& better) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < trade.runs.size(); ++i)
    if (trade.runs[i].refused.empty() && better(trade.runs[i], found ? &trade.runs[*found] : nullptr)) found = i;
  return found;
}

} // namespace

std::vector<std::size_t> mark_front(Trade& trade) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trade.runs.size(); ++i) {
    trade.runs[i].on_front = false;
    if (trade.runs[i].refused.empty()) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const MeasuredRun &x = trade.runs[a], &y = trade.runs[b];
    return x.seconds.value != y.seconds.value ? x.seconds.value < y.seconds.value : x.error.value < y.error.value;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || trade.runs[i].error.value < trade.runs[front.back()].error.value) {
      trade.runs[i].on_front = true;
      front.push_back(i);
    }
  return front;
}

double full_seconds(const Trade& trade, const MeasuredRun& run) {
  const auto render = run.stages.find("render");
  const double pixels = double{1.0} * trade.width * trade.height;
  if (render == run.stages.end() || pixels == 0.0) return run.seconds.value;
  return run.seconds.value + render->second * (double{1.0} * trade.full_width * trade.full_height / pixels - 1.0);
}

std::optional<std::size_t> fastest_within_error(const Trade& trade, double error) {
  return best(trade, [&](const MeasuredRun& run, const MeasuredRun* so_far) {
    return run.error.value <= error && (so_far == nullptr || full_seconds(trade, run) < full_seconds(trade, *so_far));
  });
}

std::optional<std::size_t> most_accurate_within(const Trade& trade, double seconds) {
  return best(trade, [&](const MeasuredRun& run, const MeasuredRun* so_far) {
    return full_seconds(trade, run) <= seconds && (so_far == nullptr || run.error.value < so_far->error.value);
  });
}

std::string command_of(const Trade& trade, const MeasuredRun& run) {
  std::string command = "pointgi render " + shell_word(trade.scene);
  for (const auto* overrides : {&trade.overrides, &run.setting.overrides})
    for (const std::string& text : *overrides)
      command += " --set " + shell_word(text);
  return command;
}

std::string csv_of(const Trade& trade) {
  std::string text = "name,knob,value,method,overrides,samples,repeats,seconds,seconds_low,seconds_high,warm_seconds,"
                     "memory_bytes,error,"
                     "error_low,error_high,noise,bias,ssim,on_front,refused\n";
  for (const MeasuredRun& run : trade.runs) {
    std::string overrides;
    for (const std::string& one : run.setting.overrides)
      overrides += (overrides.empty() ? "" : " ") + one;
    text += fmt::format(
        "{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{}\n",
        csv_field(run.name), csv_field(run.setting.knob), csv_field(run.setting.value), csv_field(run.setting.method),
        csv_field(overrides), run.samples, run.repeats.size(), run.seconds.value, run.seconds.low, run.seconds.high,
        run.warm_seconds, run.memory_bytes, run.error.value, run.error.low, run.error.high, run.noise, run.bias,
        run.ssim, run.on_front ? 1 : 0, csv_field(run.refused));
  }
  return text;
}

} // namespace pointgi
