#pragma once
/// The program's commands. Each returns the exit code and throws Error otherwise; results go to stdout, the log to
/// stderr.
#include "host/app/exit_code.h"
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

/// What every command that computes light takes.
struct LightOptions {
  std::string input;    ///< scene.toml or cloud
  std::string output;   ///< of render: .exr; empty: the input's name in the working directory; of bake: .ply
  std::string exposure; ///< stops, or "auto"; empty: as the scene has it
  std::string up;       ///< "y", "-z", ...; empty: as the scene has it, or found
  std::string ground;   ///< "auto" or "none"; empty: as the scene has it
  std::string device;
  std::optional<unsigned> seed;
  std::string quality = "normal";     ///< a name of host/scene/presets.h
  std::vector<std::string> overrides; ///< key.path=value
  std::string stats_file;
  bool resume = false;              ///< go on from what an earlier run has kept
  double checkpoint_seconds = 10.0; ///< work that took as long is kept
  bool quiet = false;
};

struct RenderOptions : LightOptions {
  std::string size; ///< "WxH"
  std::optional<int> spp;
  std::string integrator = "pointgi"; ///< or "path": unbiased path tracing, the truth to measure others by
  std::string paths;                  ///< of the path tracer: the classes that count (host/render/light_paths.h)
  std::string trace_file;
  std::string pixel_bounds; ///< "x0,x1,y0,y1"
  std::string dump_folder;
  std::optional<double> seconds; ///< --time: that the whole command may take
  std::optional<double> error;   ///< --error: relMSE that is enough
  std::string trade;             ///< trade.json, or its folder; empty: that which is kept of the scene
  bool progressive = false;      ///< a first picture soon, and better ones after it
  bool denoise = false;          ///< by Open Image Denoise
};

/// The picture that `info` tells the cost of.
struct InfoOptions : RenderOptions {
  bool no_estimate = false; ///< no device is opened
};

struct BakeOptions : LightOptions {
  bool sky = false;    ///< the share of the sky that each point sees, too
  bool passes = false; ///< the lit cloud after each pass, too
};

struct ProfileOptions {
  std::string input;  ///< scene.toml or cloud; not needed to list or write programs
  std::string output; ///< folder for profile.json, profile.md and trace.json; empty: the table alone
  std::string device;
  std::string filter; ///< parts of variants' names, separated by commas; all must be there
  int rounds = 5;
  unsigned seed = 1;
  std::vector<std::string> overrides; ///< key.path=value
  bool store = false;                 ///< the winner, even when a filter left variants out
  bool no_store = false;
  bool list = false;
  std::string programs_folder;   ///< write every program there instead
  bool pairs_of_options = false; ///< of the programs only a cover of every two options
  bool quiet = false;
};

struct MeasureCommand {
  std::string input;  ///< scene.toml or cloud
  std::string output; ///< folder for trade.json, trade.csv and pictures
  double budget = 300.0;
  std::string knobs; ///< names, separated by commas; empty: all
  std::optional<double> target;
  std::string reference; ///< .exr; empty: path traced
  std::string size;      ///< "WxH"; empty: chosen
  std::string device;
  std::vector<std::string> overrides; ///< key.path=value
  bool quiet = false;
};

struct CompareOptions {
  std::string first, second; ///< .exr
  bool json = false;
};

ExitCode run_render(const RenderOptions& options);
ExitCode run_bake(const BakeOptions& options);
ExitCode run_profile(const ProfileOptions& options);
ExitCode run_measure(const MeasureCommand& command);
ExitCode run_compare(const CompareOptions& options);
ExitCode run_info(const InfoOptions& options);
ExitCode run_devices(bool json, bool check, const std::string& device);

} // namespace pointgi
