#include "host/app/commands.h"
#include "host/cl/quirks.h"
#include "host/scene/nearest.h"
#include "host/scene/presets.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <omp.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <stdexcept>

namespace {

using namespace pointgi;

/// The log goes to stderr: stdout is for results.
void set_up_log(int verbosity, bool quiet) {
  const char* no_colour = std::getenv("NO_COLOR");
  const bool colour = no_colour == nullptr || *no_colour == '\0';
  auto logger = spdlog::stderr_color_mt("pointgi", colour ? spdlog::color_mode::automatic : spdlog::color_mode::never);
  spdlog::set_default_logger(logger);
  spdlog::set_pattern("%^%l%$: %v");
  spdlog::set_level(quiet ? spdlog::level::warn : verbosity > 0 ? spdlog::level::debug : spdlog::level::info);
}

int code_of(ExitCode code) {
  return static_cast<int>(code);
}

std::string environment_or(const std::string& flag, const char* variable) {
  const char* value = std::getenv(variable);
  return !flag.empty() || value == nullptr ? flag : value;
}

struct Common {
  int verbosity = 0;
  int threads = 0;
};

/// Threads of the host's loops and of a CPU device; before the first OpenCL call.
void limit_threads(int threads) {
  if (threads <= 0) return;
  omp_set_num_threads(threads);
  limit_driver_threads(threads);
}

/// CLI11 answers an unknown command by asking for one.
void require_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  std::string list;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    list += (list.empty() ? "" : ", ") + names.back();
  }
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string near = nearest(word, names);
  throw Error(ErrorKind::usage, "unknown command \"" + word + "\"; " +
                                    (near.empty() ? "the commands are: " + list : "did you mean \"" + near + "\"?"));
}

/// Words that no option took, the nearest option beside the first.
std::string unknown_words(CLI::App& app) {
  const CLI::App* command = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options())
    if (!option->get_lnames().empty()) known.push_back("--" + option->get_lnames().front());
  std::string word;
  for (const std::string& left : app.remaining(true))
    if (word.empty() || (left[0] == '-' && word[0] != '-')) word = left;
  const std::string near = nearest(word, known);
  return "unknown option \"" + word + "\" of " + command->get_name() +
         (near.empty() ? "; `pointgi " + command->get_name() + " --help` lists them"
                       : "; did you mean \"" + near + "\"?");
}

void add_device_options(CLI::App& command, std::string& device, Common& common) {
  command.add_option("--device", device,
                     "index, part of a name, cpu or gpu; default: the GPU of most memory that passes its self-test, "
                     "else the CPU (see: pointgi devices)");
  command.add_option("--threads", common.threads, "threads of the host and of a CPU device")
      ->check(CLI::Range(1, 1024));
}

/// What render and bake share; returns the option of the output.
CLI::Option* add_light_options(CLI::App& command, LightOptions& options, Common& common, const std::string& input,
                               const std::string& output, const std::string& exposure, const std::string& quality) {
  command.add_option("SCENE.toml|CLOUD.ply", options.input, input)->required();
  CLI::Option* to = command.add_option("-o,--output", options.output, output);
  command.add_option("--exposure", options.exposure, exposure);
  command
      .add_option("--up", options.up, "the axis that points up: y, z, x, -y, -z or -x; default: found, or the scene's")
      ->check(CLI::IsMember(std::vector<std::string>{"y", "z", "x", "-y", "-z", "-x"}));
  add_device_options(command, options.device, common);
  command.add_option("--seed", options.seed, "seed of the samples (default 1)");
  command.add_option("--quality", options.quality, quality)->check(CLI::IsMember(preset_names()));
  command
      .add_option("--set", options.overrides,
                  "a value of the scene file, e.g. camera.fov_deg=30 or cloud.0.normals=flip; may repeat")
      ->take_all()
      ->expected(1);
  command.add_option("--stats", options.stats_file, "write figures of the run to this JSON file");
  command.add_flag("--resume", options.resume,
                   "go on where an earlier run of the same command was ended, from the folder beside the output in "
                   "which it has kept what it had finished");
  command
      .add_option("--checkpoint-seconds", options.checkpoint_seconds,
                  "what took at least so many seconds is kept for --resume until the run is done (default 10; 0: all)")
      ->check(CLI::Range(0.0, 1e9));
  return to;
}

void add_render_options(CLI::App& command, RenderOptions& render) {
  command.add_option("--size", render.size, "image size, WIDTHxHEIGHT (default 640x480)");
  command.add_option("--spp", render.spp, "samples a pixel (default 32)")->check(CLI::Range(1, 65536));
  command
      .add_option("--integrator", render.integrator,
                  "how light is computed: pointgi (default), or path: slow unbiased path tracing, the truth to "
                  "measure by; ends paths by roulette, and at render.max_depth surface points where the scene says so; "
                  "it has no channel Caustic: Diffuse holds these")
      ->check(CLI::IsMember({"pointgi", "path"}));
  command.add_option("--paths", render.paths,
                     "of the path tracer: count only these light paths, e.g. LDE (direct light), LDD+E "
                     "(between surfaces), LE,LD+E (all, the default); D a diffuse surface, S a specular one, + one or "
                     "more, * any number");
  command
      .add_option("--ground", render.ground,
                  "auto puts a ground plane under what stands free, none does not (default: auto of a bare cloud)")
      ->check(CLI::IsMember({"auto", "none"}));
  command.add_option("--trace", render.trace_file, "write stages and kernels as a Chrome trace to this JSON file");
  command.add_option("--pixelbounds", render.pixel_bounds,
                     "render only x0,x1,y0,y1 (ends exclusive); the PNG holds that part");
  command
      .add_option("--time", render.seconds,
                  "seconds that the whole command may take: settings are chosen and samples added for the best picture "
                  "in them")
      ->check(CLI::Range(1e-3, 1e9));
  command
      .add_option("--error", render.error,
                  "relMSE that is enough: the fastest settings that reach it, and samples until it is reached; best "
                  "after `pointgi measure` of the scene")
      ->check(CLI::Range(1e-9, 1e9));
  command.add_option("--trade", render.trade,
                     "what --time and --error choose by: the folder of `pointgi measure` (default: its last of this "
                     "scene here)");
  command.add_flag(
      "--progressive", render.progressive,
      "write a first picture soon, and better ones after it, as --time does, and as is done on a terminal");
  command.add_flag(
      "--denoise", render.denoise,
      "take the noise out of the picture with Intel Open Image Denoise 2, which is loaded from the file or "
      "folder that POINTGI_OIDN names, else from where the loader looks");
  command.add_option("--dump-kernels", render.dump_folder, "write the kernels as compiled to this folder");
}

void add_measure_options(CLI::App& command, MeasureCommand& measure, Common& common) {
  command.add_option("SCENE.toml|CLOUD.ply", measure.input, "what to measure on")->required();
  command
      .add_option("-o,--output", measure.output,
                  "folder for trade.json, trade.csv and pictures; what it holds of the same scene is gone on with")
      ->required();
  command.add_option("--budget", measure.budget, "seconds for all, a third of them for the reference (default 300)")
      ->check(CLI::Range(1.0, 1e6));
  command.add_option("--knobs", measure.knobs,
                     "only these, separated by commas: keys of the scene file, or their last parts "
                     "(render.spp,directions); default: all that the scene needs");
  command.add_option("--target", measure.target, "print the fastest setting whose relMSE is at most this");
  command.add_option("--reference", measure.reference,
                     "compare with this picture, REFERENCE.exr, instead of a path-traced one");
  command.add_option("--size", measure.size,
                     "image size, WIDTHxHEIGHT (default: the reference's, or 160 to 320 pixels for the longest side)");
  add_device_options(command, measure.device, common);
  command.add_option("--set", measure.overrides, "a value of the scene file, as for render; may repeat")
      ->take_all()
      ->expected(1);
}

void add_info_options(CLI::App& command, InfoOptions& info, Common& common) {
  command.add_option("FILE.ply|SCENE.toml", info.input, "what to look at")->required();
  command.add_option("--size", info.size, "image size, WIDTHxHEIGHT, of the picture whose cost is told");
  command.add_option("--spp", info.spp, "samples a pixel of it")->check(CLI::Range(1, 65536));
  command.add_option("--quality", info.quality, "its quality, as for render")->check(CLI::IsMember(preset_names()));
  add_device_options(command, info.device, common);
  command.add_option("--set", info.overrides, "a value of the scene file, as for render; may repeat")
      ->take_all()
      ->expected(1);
  command.add_flag("--no-estimate", info.no_estimate, "tell nothing of stages, seconds and memory; opens no device");
}

int run(int argc, char** argv) {
  CLI::App app{"Global illumination of point clouds, without meshing them."};
  app.set_version_flag("--version", "pointgi " POINTGI_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  Common common;
  RenderOptions render;
  app.add_flag("-v", common.verbosity, "say more");
  app.add_flag("--quiet", render.quiet, "only warnings and results");

  CLI::App* render_command = app.add_subcommand("render", "render a scene, or a bare cloud");
  add_light_options(*render_command, render, common, "what to render",
                    "the picture, OUT.exr, and OUT.png beside it; default: the input's name, here; replaces older ones",
                    "brightens the PNG by this many stops, or auto: chosen from the picture (default: 0 of a scene, "
                    "auto of a bare cloud)",
                    "draft: a quarter of the scene's samples a pixel, half of its radiosity.directions and four times "
                    "its radiosity.epsilon; normal: the scene's own; high: four times, twice and half of them; final: "
                    "16 times, four times and a quarter");
  add_render_options(*render_command, render);

  BakeOptions bake;
  CLI::App* bake_command =
      app.add_subcommand("bake", "compute the light once for all views, and write it as a point cloud");
  add_light_options(*bake_command, bake, common, "what to light",
                    "the lit cloud, LIT.ply: colours, and radiosity [W/m2] as scalar fields",
                    "brightens the colours by this many stops, or auto: chosen from the points (default: 0 of a "
                    "scene, auto of a bare cloud); the radiosity stays as it is",
                    "draft: four times the scene's radiosity.epsilon and half of its directions; normal: the scene's "
                    "own; high: half and twice; final: a quarter and four times")
      ->required();
  bake_command->add_flag("--sky", bake.sky,
                         "add scalar_sky, the share of the sky that each point sees (ambient occlusion); of a scene "
                         "without light nothing else is computed");

  bake_command->add_flag("--passes", bake.passes,
                         "write the lit cloud as it is after each pass of radiosity.method = \"gather\", too: "
                         "LIT.pass-001.ply and so on");

  ProfileOptions profile;
  CLI::App* profile_command =
      app.add_subcommand("profile", "time every kernel variant on a scene; render uses the best");
  profile_command->add_option("SCENE.toml|CLOUD.ply", profile.input, "what to measure on");
  profile_command->add_option(
      "-o,--output", profile.output,
      "folder for profile.json, profile.md (the table) and trace.json (Chrome trace); default: the table alone");
  add_device_options(*profile_command, profile.device, common);
  profile_command->add_option("--filter", profile.filter,
                              "only variants whose names contain this; several parts, separated by commas, must all "
                              "be there (wide,leaf64); the best is then stored only with --store");
  profile_command->add_option("--rounds", profile.rounds, "timed launches of each (default 5)")
      ->check(CLI::Range(1, 1000));
  profile_command->add_option("--seed", profile.seed, "seed of the bounced rays (default 1)");
  profile_command->add_option("--set", profile.overrides, "a value of the scene file, as for render; may repeat")
      ->take_all()
      ->expected(1);
  CLI::Option* store = profile_command->add_flag(
      "--store", profile.store, "keep the best, for render to find, even when --filter left variants out");
  profile_command->add_flag("--no-store", profile.no_store, "do not keep the best")->excludes(store);
  profile_command->add_flag("--list", profile.list, "only list the variants, what they need, and which are valid here");
  CLI::Option* write_programs = profile_command->add_option("--write-programs", profile.programs_folder,
                                                            "only write each distinct program of all variants to this "
                                                            "folder, with an index.tsv: file, source, kinds of device, "
                                                            "options; needs no device");
  profile_command
      ->add_flag("--pairs-of-options", profile.pairs_of_options,
                 "of these programs only some, in which every two options of a kernel file meet that meet in any")
      ->needs(write_programs);

  MeasureCommand measure;
  CLI::App* measure_command =
      app.add_subcommand("measure", "measure what time buys: error against seconds of a scene's settings");
  add_measure_options(*measure_command, measure, common);

  InfoOptions info;
  CLI::App* info_command =
      app.add_subcommand("info", "what is in a cloud or scene, which stages its picture needs, and what they cost");
  add_info_options(*info_command, info, common);

  CompareOptions compare;
  CLI::App* compare_command = app.add_subcommand("compare", "how far two pictures are apart");
  compare_command->add_option("A.exr", compare.first, "the picture to judge")->required();
  compare_command->add_option("B.exr", compare.second, "what it is held against: the truth")->required();
  compare_command->add_flag("--json", compare.json, "as JSON");

  bool json = false, check = false;
  std::string checked_device;
  CLI::App* devices_command = app.add_subcommand("devices", "the OpenCL devices");
  devices_command->add_flag("--json", json, "as JSON");
  devices_command->add_flag("--check", check, "compile every kernel on each");
  devices_command->add_option("--device", checked_device, "only this one");

  if (argc > 1 && argv[1][0] != '-') require_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) { // --help, --version
    app.exit(help);
    return code_of(ExitCode::done);
  } catch (const CLI::ExtrasError& error) {
    throw Error(ErrorKind::usage, unknown_words(app));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::usage,
                std::string(error.what()) + "; `pointgi" +
                    (app.get_subcommands().empty() ? std::string() : " " + app.get_subcommands()[0]->get_name()) +
                    " --help` lists what there is");
  }
  set_up_log(common.verbosity, render.quiet);
  limit_threads(common.threads);
  std::signal(SIGXFSZ, SIG_IGN); // a file size limit is then a write error, reported as one
  render.device = environment_or(render.device, "POINTGI_DEVICE");
  if (render_command->parsed()) return code_of(run_render(render));
  bake.device = environment_or(bake.device, "POINTGI_DEVICE");
  bake.quiet = render.quiet;
  if (bake_command->parsed()) return code_of(run_bake(bake));
  profile.device = environment_or(profile.device, "POINTGI_DEVICE");
  profile.quiet = render.quiet;
  if (profile_command->parsed()) return code_of(run_profile(profile));
  measure.device = environment_or(measure.device, "POINTGI_DEVICE");
  measure.quiet = render.quiet;
  if (measure_command->parsed()) return code_of(run_measure(measure));
  if (compare_command->parsed()) return code_of(run_compare(compare));
  info.device = environment_or(info.device, "POINTGI_DEVICE");
  info.quiet = render.quiet;
  if (info_command->parsed()) return code_of(run_info(info));
  return code_of(run_devices(json, check, environment_or(checked_device, "POINTGI_DEVICE")));
}

constexpr const char no_memory[] = "out of memory; use a smaller cloud or a coarser spacing";

int fail(ExitCode code, const char* text) {
  std::fprintf(stderr, "error: %s\n", text);
  return code_of(code);
}

std::terminate_handler other_ends = nullptr;

/// Some destructors allocate, as those of the JSON library do. Where they get no memory no exception can pass, and main
/// would not hear of it.
[[noreturn]] void end_without_memory() {
  if (std::current_exception()) try {
      throw;
    } catch (const std::bad_alloc&) {
      std::_Exit(fail(ExitCode::memory, no_memory));
    } catch (...) { // not ours to explain
    }
  if (other_ends != nullptr) other_ends();
  std::abort();
}

} // namespace

/// The one place where errors become exit codes.
int main(int argc, char** argv) {
  other_ends = std::set_terminate(end_without_memory);
  try {
    const int code = run(argc, argv);
    if (std::fflush(stdout) != 0) return fail(ExitCode::output, "stdout cannot be written; is its disk full?");
    return code;
  } catch (const pointgi::Error& error) {
    return fail(exit_code_of(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::memory, no_memory);
  } catch (const std::length_error& error) { // more than 32-bit places hold
    return fail(ExitCode::memory, error.what());
  } catch (const std::exception& error) {
    return fail(ExitCode::internal, error.what());
  }
}
