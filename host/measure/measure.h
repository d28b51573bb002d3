#pragma once
/// Speed against accuracy of one scene on one device, by pictures that are made and timed.
#include "host/api/context.h"
#include "host/measure/trade.h"
#include <chrono>
#include <functional>
#include <utility>

namespace pointgi {

struct MeasureOptions {
  std::string scene;                  ///< scene file or cloud
  std::vector<std::string> overrides; ///< of all runs
  std::string folder;                 ///< for pictures and the reference; an earlier trade.json there is gone on with
  double budget = 300.0;              ///< seconds, above 0
  std::vector<std::string> knobs;     ///< names (host/measure/knobs.h); empty: all
  std::string reference_file;         ///< an EXR file to compare with; empty: path traced
  std::optional<std::pair<int, int>> size; ///< absent: chosen, or the reference file's
  std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now(); ///< of the budget
};

struct Measured {
  Trade trade;
  bool interrupted = false; ///< `trade` holds what was measured until then
};

/// Makes the reference, in a third of the budget at most, and searches in the rest of it (host/measure/search.h).
/// Writes pictures and the halves of the reference below the folder; hands the trade to `save` now and then, and at the
/// end. A run that does not end in its time is stopped and refused. A first run of new kernels builds them and is not
/// counted. Throws Error: input for scene or reference file, device, memory, output; interrupted when nothing was
/// measured yet.
Measured measure(const api::Context& context, const MeasureOptions& options, const RunControl& run,
                 const std::function<void(const Trade&)>& save);

/// Hash of what the outcome depends on besides program and device: the overrides, and size and time of the scene's
/// file, of all files that it names (host/scene/input_files.h) and of the reference file.
std::string state_of(const MeasureOptions& options);

/// The names of what measure() and the command line write into the folder.
inline constexpr char trade_json_name[] = "trade.json", trade_csv_name[] = "trade.csv", pictures_name[] = "pictures";

} // namespace pointgi
