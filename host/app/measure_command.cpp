#include "host/app/command_run.h"
#include "host/app/commands.h"
#include "host/app/numbers.h"
#include "host/app/output_files.h"
#include "host/app/stats.h"
#include "host/measure/kept_errors.h"
#include "host/measure/knobs.h"
#include "host/measure/measure.h"
#include "host/measure/report.h"
#include "host/measure/stored_trade.h"
#include "host/output_folder.h"
#include <cmath>
#include <cstdio>
#include <spdlog/spdlog.h>
#include <sstream>

namespace pointgi {

namespace {

/// Below this a picture has too few tiles for an interval of its error (host/measure/reference.h).
constexpr int least_side = 32;

std::vector<std::string> knobs_of(const std::string& list) {
  std::vector<std::string> knobs;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');)
    knobs.push_back(checked_knob(part));
  if (!list.empty() && knobs.empty()) checked_knob(""); // says which there are
  return knobs;
}

MeasureOptions checked(const MeasureCommand& command) {
  MeasureOptions options;
  options.scene = command.input;
  options.overrides = command.overrides;
  options.folder = command.output;
  options.budget = command.budget;
  options.knobs = knobs_of(command.knobs);
  options.reference_file = command.reference;
  if (!command.size.empty()) options.size = size_of(command.size, least_side);
  if (command.target && !(*command.target > 0.0 && std::isfinite(*command.target)))
    throw Error(ErrorKind::usage, "--target: expected an error above 0, for example 1e-3");
  state_of(options); // reads the scene
  require_writable(options.folder, {std::string(pictures_name) + "/reference.png", kept_errors_name, trade_json_name,
                                    trade_csv_name, report_name});
  return options;
}

void save(const std::string& folder, const Trade& trade) {
  write_text(file_in(folder, trade_json_name), json_of(trade));
  write_text(file_in(folder, trade_csv_name), csv_of(trade));
}

void print_run(const MeasuredRun& run, const MeasuredRun& own) {
  std::printf("%9.3g %12.3g  %9.2g to %-9.2g %+8.2f%% %6.2fx  %s\n", run.seconds.value, run.error.value, run.error.low,
              run.error.high, 100.0 * run.bias, own.seconds.value / run.seconds.value, run.name.c_str());
}

void print_front(Trade& trade) {
  const std::vector<std::size_t> front = mark_front(trade);
  std::printf("%s on %s, %dx%d pixels; reference: %s, its own relMSE %.2g\n", trade.scene.c_str(), trade.device.c_str(),
              trade.width, trade.height, trade.reference.source.c_str(), trade.reference.own_noise);
  std::printf("%9s %12s  %-22s %9s %7s  %s\n", "seconds", "relMSE", "95 % interval", "bias", "speed", "setting");
  for (const std::size_t i : front)
    print_run(trade.runs[i], trade.runs.front());
  if (!trade.runs.front().on_front) {
    std::printf("not on the front, for comparison:\n");
    print_run(trade.runs.front(), trade.runs.front());
  }
  std::size_t refused = 0;
  for (const MeasuredRun& run : trade.runs)
    refused += run.refused.empty() ? 0 : 1;
  std::printf("%zu settings measured, %zu refused, %.0f s of %.0f s\n", trade.runs.size() - refused, refused,
              trade.spent_seconds, trade.budget_seconds);
}

/// Errors that the reference's noise hides.
void warn_of_noise(const Trade& trade) {
  std::size_t front = 0, hidden = 0;
  for (const MeasuredRun& run : trade.runs) {
    front += run.on_front;
    hidden += run.on_front && run.repeats.size() > 1 && run.error.low <= 0.0; // of one run it may be too wide
  }
  if (2 * hidden > front)
    spdlog::warn(
        "the reference is too noisy for small errors: the intervals of {} of {} settings reach 0; a larger --budget, "
        "or --reference, gives a better one",
        hidden, front);
}

void print_recommendation(const Trade& trade, double target) {
  if (const auto best = fastest_within_error(trade, target)) {
    std::printf("the fastest to a relMSE of %.3g:\n%s\n", target, command_of(trade, trade.runs[*best]).c_str());
    return;
  }
  const auto closest = most_accurate_within(trade, 1e300);
  if (!closest) return;
  std::printf("no setting reached a relMSE of %.3g; the most accurate one, %.3g:\n%s\n", target,
              trade.runs[*closest].error.value, command_of(trade, trade.runs[*closest]).c_str());
}

} // namespace

ExitCode run_measure(const MeasureCommand& command) {
  CommandRun run(command.quiet);
  const MeasureOptions options = checked(command);
  const api::Context context(command.device, run.control());
  spdlog::info("device: {}; about {} for all", context.device(), duration_text(options.budget));
  Measured measured =
      measure(context, options, run.control(), [&](const Trade& trade) { save(options.folder, trade); });
  run.end_progress();
  print_front(measured.trade);
  warn_of_noise(measured.trade);
  store_trade(measured.trade);
  write_report(measured.trade, json_of(measured.trade), options.folder);
  if (command.target) print_recommendation(measured.trade, *command.target);
  for (const char* name : {report_name, trade_json_name, trade_csv_name})
    std::printf("%s\n", file_in(options.folder, name).c_str());
  if (!measured.interrupted) return ExitCode::done;
  spdlog::warn("interrupted: what was measured is kept, and the same command goes on with it");
  return ExitCode::interrupted;
}

} // namespace pointgi
