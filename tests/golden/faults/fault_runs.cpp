#include "tests/golden/faults/fault_runs.h"
#include "host/error.h"
#include "host/image/picture_writer.h"
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace pointgi::test {

namespace {

namespace fs = std::filesystem;

/// Spheres, a mirror and glass: light between surfaces, photons, and rounds of both.
const char* scene_text() {
  return "version = 1\n[render]\nsize = [24, 24]\nspp = 2\n"
         "[camera]\nposition = [0.0, 0.6, 3.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg = 40.0\n"
         "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n"
         "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n"
         "[[material]]\nname = \"glass\"\ntype = \"glass\"\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [-0.4, 0.0, 0.0]\nradius = 0.4\nspacing = 0.12\nmaterial = \"grey\"\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.5, 0.0, 0.3]\nradius = 0.4\nspacing = 0.12\nmaterial = \"glass\"\n"
         "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -0.5, -1.0]\nedge_u = [0.0, 0.0, 2.0]\n"
         "edge_v = [2.0, 0.0, 0.0]\nspacing = 0.2\nmaterial = \"grey\"\n"
         "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -0.5, -1.0]\nedge_u = [2.0, 0.0, 0.0]\n"
         "edge_v = [0.0, 1.0, 0.0]\nspacing = 0.2\nmaterial = \"mirror\"\n"
         "[[light]]\ntype = \"point\"\nposition = [1.0, 2.0, 2.0]\npower_w = [90.0, 90.0, 90.0]\n"
         "[caustics]\nphotons = 2000\nfeedback = true\n";
}

constexpr const char* outputs[] = {"a.exr", "a.png", "stats.json", "trace.json"};
constexpr char old_bytes[] = "what was there before";
constexpr int seconds_of_a_hang = 60, seconds_to_compile = 600;

CallReport read_report(const std::string& path) {
  CallReport report;
  std::istringstream lines(contents(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind, name;
    words >> kind >> name;
    if (kind == "count") words >> report.counts[name];
    if (kind == "largest") words >> report.largest[name];
    if (kind == "live") words >> report.live[name];
    if (kind == "place") {
      report.places.push_back(name);
      std::size_t count = 0;
      words >> count;
      std::getline(words, report.addresses[name]);
    }
    if (kind == "struck") {
      report.struck = std::stoul(name);
      report.is_there = true;
    }
  }
  return report;
}

bool is_json(const std::string& text) {
  return nlohmann::json::accept(text);
}

/// What is unclear in what an unfinished run said.
std::string unclear(const std::string& err) {
  std::size_t errors = 0, at = std::string::npos;
  for (std::size_t from = 0; (from = err.find("error: ", from)) != std::string::npos; from += 7)
    if (from == 0 || err[from - 1] == '\n') {
      ++errors;
      at = from;
    }
  if (errors != 1) return std::to_string(errors) + " errors are told, not one";
  if (err.find("; ", at) == std::string::npos) return "the error has no remedy";
  return {};
}

/// Whose fault the exit code may say it is.
std::set<int> codes_for(const std::string& call) {
  if (call == "allocation") return {6};
  if (call.rfind("cl", 0) == 0 && call != "close") return {4, 6};
  return {3, 5};
}

} // namespace

std::string Fault::text() const {
  return call + " " + at + (code == kill_there ? " kills" : " answers " + std::to_string(code)) +
         (lasts ? ", and all after it" : "");
}

FaultScene::Way fmm_way() {
  return {"fmm", "--set radiosity.method=fmm", "", false};
}
FaultScene::Way directions_way() {
  return {"directions", "--set radiosity.method=directions", "", false};
}
FaultScene::Way images_way() {
  return {"images", "--set radiosity.method=directions --set traversal.storage=image2d", "", false};
}
FaultScene::Way cached_programs_way() {
  // Of a platform of this name nobody knows that its driver keeps compiled kernels itself.
  return {"cached programs", "--set radiosity.method=directions", "DEVICE_PLATFORM=Another ", true};
}

std::string with_faults() {
  return "env LD_PRELOAD=" POINTGI_FAULTS_LIBRARY;
}

FaultScene::FaultScene(const Way& way) : way_(way) {
  folder_.write("scene.toml", scene_text());
  CallReport ignored;
  limit_seconds_ = seconds_to_compile;
  for (const bool counts : {false, true}) {
    const Run made = run("", "", 0, counts ? calls_ : ignored);
    if (made.code != 0 || !(counts ? calls_ : ignored).is_there)
      throw std::runtime_error("the scene of the faults is not rendered: " + made.err);
  }
  channels_ = read_exr(output("a.exr")).channels;
  png_ = contents(output("a.png"));
  for (const auto& entry : fs::recursive_directory_iterator(folder_of(0) + "/cache"))
    if (entry.path().extension() == ".vmap") vmap_ = contents(entry.path().string());
  limit_seconds_ = seconds_of_a_hang;
}

std::string FaultScene::folder_of(int slot) const {
  return folder_.file("slot" + std::to_string(slot));
}

/// A slot that is new begins with the cache that the undisturbed run left, where caches are kept.
void FaultScene::put_old_files(int slot) const {
  const std::string folder = folder_of(slot), cache = folder + "/cache";
  fs::remove_all(folder + "/out");
  fs::create_directories(folder + "/out");
  for (const char* name : outputs)
    std::ofstream(folder + "/out/" + name) << old_bytes;
  if (!way_.keeps_cache) fs::remove_all(cache);
  if (way_.keeps_cache && slot != 0 && !fs::exists(cache))
    fs::copy(folder_of(0) + "/cache", cache, fs::copy_options::recursive);
  fs::create_directories(cache);
}

Run FaultScene::run(const std::string& variables, const std::string& options, int slot, CallReport& report) const {
  put_old_files(slot);
  const std::string folder = folder_of(slot), out = folder + "/out/", told = folder + "/report";
  fs::remove(told);
  const Run run = run_program("render " + folder_.file("scene.toml") + " --quiet " + way_.options + " -o " + out +
                                  "a.exr --stats " + out + "stats.json --trace " + out + "trace.json " + options,
                              "timeout -s KILL " + std::to_string(limit_seconds_) + " " + with_faults() +
                                  " POINTGI_DEVICE=cpu POINTGI_CACHE_DIR=" + folder + "/cache FAULT_REPORT=" + told +
                                  " " + way_.variables + variables);
  report = read_report(told);
  return run;
}

/// Each file is the old one or a whole new one; where the run `finished`, new.
std::string FaultScene::wrong_file(int slot, bool finished, bool may_leave_temporary) const {
  const std::string folder = folder_of(slot) + "/out/";
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (may_leave_temporary && entry.path().extension() == ".tmp") continue;
    if (std::find(std::begin(outputs), std::end(outputs), name) == std::end(outputs)) return "leaves the file " + name;
  }
  for (const std::string name : outputs) {
    if (!fs::exists(folder + name)) return "loses the old " + name;
    const std::string bytes = contents(folder + name);
    if (bytes == old_bytes) {
      if (finished) return "says that all is well, and does not write " + name;
      continue;
    }
    if (name == "a.exr") try {
        if (read_exr(folder + name).channels != channels_) return "writes a wrong picture";
      } catch (const Error& error) {
        return error.what();
      }
    if (name == "a.png" && bytes != png_) return "writes a wrong PNG";
    if (fs::path(name).extension() == ".json" && !is_json(bytes)) return "writes half of " + name;
  }
  return {};
}

std::string FaultScene::wrong_cache(int slot, bool may_leave_temporary) const {
  for (const auto& entry : fs::recursive_directory_iterator(folder_of(slot) + "/cache")) {
    const std::string name = entry.path().filename().string();
    if (!may_leave_temporary && entry.path().extension() == ".tmp") return "leaves the file " + name + " in the cache";
    if (entry.path().extension() == ".vmap" && contents(entry.path().string()) != vmap_) return "keeps a wrong V-map";
  }
  return {};
}

Judgement FaultScene::judge(const Fault& fault, int slot) const {
  CallReport report;
  const Run made = run("FAULT_CALL=" + fault.call + " FAULT_AT=" + fault.at +
                           " FAULT_CODE=" + std::to_string(fault.code) + (fault.lasts ? " FAULT_LASTS=1" : ""),
                       "", slot, report);
  const auto broken = [&](const std::string& finding) {
    std::string where;
    if (fault.call == "allocation") where = " [" + calls_.addresses.at(fault.at) + " ]";
    return Judgement{Outcome::broken, way_.name + ": " + fault.text() + where + ": " + finding + "; exit code " +
                                          std::to_string(made.code) + ": " + made.err.substr(0, 600)};
  };
  const bool killed = fault.code == kill_there && made.code == 128 + 9;
  if (made.code == 137 && !report.is_there && !killed) return broken("hangs, or is killed");
  // Memory that ends in a destructor ends the program there, and no library hears of it.
  const bool ends_early = fault.call == "allocation" && made.code == 6;
  if (!killed && (made.code >= 128 || (!report.is_there && !ends_early))) return broken("crashes");
  if (const std::string wrong = wrong_file(slot, made.code == 0, killed); !wrong.empty()) return broken(wrong);
  if (const std::string wrong = wrong_cache(slot, killed); !wrong.empty()) return broken(wrong);
  if (killed) return {Outcome::killed, {}};
  // The JSON library loses what it has made of a list for which memory ends: of the reports, after the picture.
  const bool has_picture = contents(output("a.exr", slot)) != old_bytes;
  for (const auto& [name, count] : report.live)
    if (calls_.live.count(name) == 0 && !(ends_early && has_picture))
      return broken(std::to_string(count) + " " + name + " are not given back");
  if (made.code == 0) return {report.struck > 0 ? Outcome::right_picture : Outcome::not_met, {}};
  if (report.is_there && report.struck == 0) return broken("fails without a fault");
  if (codes_for(fault.call).count(made.code) == 0) return broken("ends with a wrong exit code");
  if (const std::string wrong = unclear(made.err); !wrong.empty()) return broken(wrong);
  return {Outcome::clear_error, {}};
}

std::string FaultScene::undisturbed(const std::string& variables, int slot) const {
  CallReport report;
  const Run made = run(variables, "", slot, report);
  if (made.code != 0) return "exit code " + std::to_string(made.code) + ": " + made.err;
  return wrong_file(slot, true, false);
}

} // namespace pointgi::test
