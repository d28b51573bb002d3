#pragma once
/// What a measurement of speed against accuracy holds: the runs, and the reference that they are compared with.
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

/// One way to make the picture: the scene's own settings but for these.
struct Setting {
  std::vector<std::string> overrides; ///< "radiosity.directions=64", as --set takes them; none: the scene as it is
  std::string knob;                   ///< the knob (host/measure/knobs.h) that this run belongs to; empty: several
  std::string value;                  ///< of the knob, "64"
  std::string method;                 ///< radiosity.method that solved the light, after "auto" has chosen
};

/// A figure with the interval that holds it in 95 of 100 measurements.
struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// One setting, measured. Times are of a process that has its kernels. Light that differs from another run's in
/// render.spp alone was solved once for both, and its seconds count in both.
struct MeasuredRun {
  std::string name; ///< unique, usable in a file name: "directions-64"
  Setting setting;
  int samples = 1;                      ///< a pixel
  std::vector<double> repeats;          ///< seconds of each repetition, from the prepared cloud to the picture, cold:
                                        ///< with a visibility map made anew
  Estimate seconds;                     ///< median of `repeats`; see set_time_intervals (host/measure/intervals.h)
  std::map<std::string, double> stages; ///< seconds of each stage, scaled to the median
  std::uint64_t memory_bytes = 0;       ///< device_peak_bytes of the run
  Estimate error;                       ///< relMSE against the reference, whose own noise is taken off; low may be < 0
  double noise = std::numeric_limits<double>::infinity(); ///< of `error`, what the pixels' variances tell; infinite: of
                                                          ///< one sample nothing is known
  double warm_seconds = 0.0; ///< of one more run, with a kept visibility map; 0: not measured
  double bias = 0.0;         ///< of the mean, relative
  double ssim = 0.0;
  std::string picture;   ///< file beside trade.json, "pictures/directions-64.png"
  bool on_front = false; ///< no other run is both faster and more accurate
  std::string refused;   ///< why the setting could not be run; then the figures are 0
};

/// One knob's curve and what theory says of it.
struct KnobCurve {
  std::string knob;
  std::vector<std::string> runs; ///< names, in the order of the values
  bool falls = false;            ///< theory says that the error falls along them
  std::string finding;           ///< "falls", or where it does not and why, for the reader; without runs, why not
  std::string about = {};        ///< the run whose other settings they have; empty: the scene's own
  std::vector<std::string> values = {}; ///< of the knob, of each run: "64"
  std::string own = {};                 ///< the scene's own value, where it is one of the knob's
};

struct TradeReference {
  std::string source;     ///< "path tracer, twice 512 samples a pixel", or a file
  std::string picture;    ///< "pictures/reference.png"
  double own_noise = 0.0; ///< relMSE of the mean of its halves; taken off every error
  double seconds = 0.0;
  std::string file = {}; ///< that was given; empty: path traced
};

struct Trade {
  std::string version, scene, device, date; ///< date: YYYY-MM-DD
  std::vector<std::string> overrides;       ///< that all runs have besides their own, as --set takes them
  std::string state;                        ///< hash of the files of the scene, by which a resumed one is known
  int width = 0, height = 0;                ///< pixels of the pictures that are measured
  int full_width = 0, full_height = 0;      ///< of those that the scene asks for
  double budget_seconds = 0.0, spent_seconds = 0.0;
  double prepare_seconds = 0.0; ///< of loading the clouds and building the octree, which no run's seconds hold
  TradeReference reference;
  std::vector<MeasuredRun> runs;
  std::vector<KnobCurve> knobs;
};

/// The runs that no other beats in both seconds and error, fastest first; refused runs are not among them. Sets their
/// `on_front`.
std::vector<std::size_t> mark_front(Trade& trade);

/// Seconds of the run's setting in a picture of full_width x full_height: the stage "render" grows with the pixels, and
/// the light does not.
double full_seconds(const Trade& trade, const MeasuredRun& run);

/// Of a picture of that size the fastest run whose error is at most `error`, and the most accurate that takes at most
/// `seconds`; absent: none.
std::optional<std::size_t> fastest_within_error(const Trade& trade, double error);
std::optional<std::size_t> most_accurate_within(const Trade& trade, double seconds);

/// The command that makes the run's picture again: pointgi render SCENE --set ...
std::string command_of(const Trade& trade, const MeasuredRun& run);

/// trade.json, whose keys are the members' names, and back; trade.csv has a line a run, after one with the names of the
/// columns. What is not finite is null there. read_trade throws Error(input) that names the file and what is wrong in
/// it.
std::string json_of(const Trade& trade);
Trade read_trade(const std::string& path);
std::string csv_of(const Trade& trade);

} // namespace pointgi
