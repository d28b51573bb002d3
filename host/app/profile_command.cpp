#include "host/app/command_run.h"
#include "host/app/commands.h"
#include "host/app/profile_report.h"
#include "host/app/stats.h"
#include "host/cl/kernel_source.h"
#include "host/cl/session.h"
#include "host/output_folder.h"
#include "host/repeats.h"
#include "host/stages/prepare.h"
#include "host/tune/program_cover.h"
#include "host/tune/self_test.h"
#include "host/tune/tuned.h"
#include <algorithm>
#include <cstdio>
#include <spdlog/spdlog.h>
#include <sstream>

namespace pointgi {

namespace {

/// Those whose names contain every part of the comma-separated filter.
std::vector<TraversalVariant> filtered(const std::string& filter) {
  std::vector<TraversalVariant> result;
  for (const TraversalVariant& v : all_variants()) {
    const std::string name = name_of(v);
    std::istringstream parts(filter);
    bool fits = true;
    for (std::string part; std::getline(parts, part, ',');)
      fits = fits && name.find(part) != std::string::npos;
    if (fits) result.push_back(v);
  }
  if (result.empty())
    throw Error(ErrorKind::usage, "--filter " + filter +
                                      ": no variant has that in its name; `pointgi profile --list` "
                                      "shows the names");
  return result;
}

constexpr const char* json_name = "profile.json";
constexpr const char* markdown_name = "profile.md";
constexpr const char* trace_name = "trace.json";

/// Each program as a compiler sees it, includes resolved, and an index of what it is built with: for compilers of
/// devices that are not at hand.
void write_programs(const std::string& folder, bool pairs_only) {
  make_folder(folder);
  std::string index;
  const std::vector<ProgramUse> programs = pairs_only ? cover_of_pairs(all_programs()) : all_programs();
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const ProgramUse& use = programs[i];
    char name[32];
    std::snprintf(name, sizeof name, "%03zu.cl", i);
    write_text(file_in(folder, name), kernel_source(use.program.file));
    index += std::string(name) + "\t" + use.program.file + "\t" +
             (use.cpu && use.gpu ? "cpu,gpu"
              : use.cpu          ? "cpu"
                                 : "gpu") +
             "\t" + use.program.options + "\n";
  }
  write_text(file_in(folder, "index.tsv"), index);
  std::printf("%s\n", file_in(folder, "index.tsv").c_str());
}

/// Rays a launch of the picture below which its times are those of launching: 60 x 60 pixels of 8 x 4.
constexpr std::uint64_t fewest_rays_to_store = 100'000;

/// Stores the winner when the run tells what is best of all; says in the report what was done.
void store(const ProfileOptions& options, ProfileReport& report) {
  const VariantProfile* winner = report.profile.winner();
  if (winner == nullptr) return;
  const KernelProfile& render = winner->kernels[static_cast<std::size_t>(ProfiledKernel::render)];
  if (options.no_store)
    report.not_stored = "--no-store";
  else if (report.profile.interrupted)
    report.not_stored = "interrupted before all were measured";
  else if (!options.filter.empty() && !options.store)
    report.not_stored = "--filter left variants out that may be faster; --store stores it all the same";
  else if (render.rays < fewest_rays_to_store && !options.store)
    report.not_stored = "the picture has too few rays to tell what is best for others; --store stores it all the same";
  else
    try {
      report.stored = store_winner(report.device, winner->variant, report.scene,
                                   static_cast<double>(render.rays) / median_of_repeats(render.seconds));
    } catch (const Error& error) { // the figures are worth having without a cache
      report.not_stored = error.what();
      spdlog::warn("{}", error.what());
    }
}

Profile measure(Session& session, const Scene& scene, const PlacedSplats& placed, const ProfileOptions& options,
                const std::vector<TraversalVariant>& valid, StageLog& stages) {
  ProfileRequest request{scene, placed.frame, placed.splats, placed.clips, placed.bends, valid};
  request.rounds = options.rounds;
  request.seed = options.seed;
  // A quarter, for the scene's own buffers and other programs want some; on a CPU device it is the host's memory too.
  request.pool_bytes = std::min(request.pool_bytes, session.info().memory_bytes / 4);
  stages.start("profile");
  Profile profile = profile_variants(
      session, request, [](double share) { report_progress(share); }, stop_asked);
  std::size_t launches = 0;
  double seconds = 0.0;
  for (const auto& [name, time] : session.kernel_times()) {
    launches += time.launches;
    seconds += time.seconds;
  }
  stages.finish(launches, "launches", seconds);
  return profile;
}

} // namespace

ExitCode run_profile(const ProfileOptions& options) {
  if (!options.programs_folder.empty()) {
    write_programs(options.programs_folder, options.pairs_of_options);
    return ExitCode::done;
  }
  const std::vector<TraversalVariant> wanted = filtered(options.filter);
  if (options.list) {
    std::printf("%s", variant_listing(wanted, choose_device(options.device).info).c_str());
    return ExitCode::done;
  }
  if (options.input.empty())
    throw Error(ErrorKind::usage, "profile: a scene or cloud to measure on is required; `pointgi profile --help` lists "
                                  "what there is");
  CommandRun run(options.quiet);
  StageLog stages;
  stages.start("scene");
  Scene scene = load_any(options.input, options.overrides);
  if (says_something(scene.traversal, scene.octree))
    spdlog::info("[octree] and [traversal] of the scene do not narrow the variants: --filter does");
  if (!options.output.empty()) require_writable(options.output, {json_name, markdown_name, trace_name});
  stages.finish(scene.clouds.size() + scene.shapes.size(), "objects");

  Session session(choose_tested_device(options.device));
  spdlog::info("device: {} ({}, driver {})", session.info().name, session.info().platform, session.info().driver);
  if (!options.output.empty()) session.record_launches();
  stages.start("cloud");
  const PlacedSplats placed = load_and_place(scene, !is_scene_file(options.input));
  stages.finish(placed.splats.size(), "points");

  std::vector<TraversalVariant> valid, invalid;
  for (TraversalVariant v : wanted) {
    v.patches = !placed.bends.empty();
    (why_not(v, session.info()).empty() ? valid : invalid).push_back(v);
  }
  spdlog::info("{} variants, {} rounds; the first start compiles their kernels", valid.size(), options.rounds);
  const Profile profile = measure(session, scene, placed, options, valid, stages);

  ProfileReport report{session.info(), profile};
  report.scene = options.input;
  report.filter = options.filter;
  report.splats = placed.splats.size();
  report.rounds = options.rounds;
  report.seed = options.seed;
  report.invalid = invalid;
  store(options, report);
  run.end_progress();
  std::printf("%s", profile_table(report).c_str());
  if (!options.output.empty()) {
    write_text(file_in(options.output, json_name), profile_json(report, stages).dump(1) + "\n");
    write_text(file_in(options.output, markdown_name), profile_markdown(report));
    write_text(file_in(options.output, trace_name), stages.chrome_trace(session.launches()));
    for (const char* name : {json_name, markdown_name, trace_name})
      std::printf("%s\n", file_in(options.output, name).c_str());
  }
  if (!profile.interrupted) return ExitCode::done;
  spdlog::warn("interrupted: the table holds what was measured until then");
  return ExitCode::interrupted;
}

} // namespace pointgi
