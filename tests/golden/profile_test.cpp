/// `pointgi profile` as a user starts it, and `render` after it. No test looks at a time.
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

using namespace pointgi::test;
using Catch::Contains;

namespace {

nlohmann::json json_of(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

/// The folder, scene and cache of one test: what it stores is nobody else's.
struct Setting {
  TemporaryFolder folder;
  std::string scene = folder.write("ball.toml", small_scene());
  std::string out = folder.file("out");
  std::string before = "POINTGI_CACHE_DIR=" + folder.file("cache");

  Run profile(const std::string& more, const std::string& variables = "") const {
    return run_program("profile " + scene + " -o " + out + " " + more, before + " " + variables);
  }
  Run render(const std::string& more = "") const {
    return run_program(
        "render " + scene + " -o " + folder.file("x.exr") + " --stats " + folder.file("s.json") + " " + more, before);
  }
  std::string stored() const {
    const std::filesystem::path tuned = folder.file("cache/tuned");
    if (!std::filesystem::exists(tuned)) return {};
    for (const auto& entry : std::filesystem::directory_iterator(tuned))
      return entry.path().string();
    return {};
  }
};

const nlohmann::json& named(const nlohmann::json& profile, const std::string& name) {
  for (const auto& v : profile["variants"])
    if (v["name"] == name) return v;
  throw std::runtime_error("no variant " + name);
}

const char* wide_packet = "wide-lanes8-morton-leaf64-packet-8x4";
const char* reference = "step-n2-buffer-morton-leaf32-ray-8x4";

} // namespace

TEST_CASE("profile measures, checks, tells and stores, and render uses what was stored", "[long]") {
  const Setting s;
  const Run run = s.profile(std::string("--rounds 2 --store --filter lanes16,leaf32-packet-16x4,morton"));
  REQUIRE(run.code == 0);
  const std::string best = "wide-lanes16-morton-leaf32-packet-16x4";
  CHECK_THAT(run.out, Contains(best) && Contains(reference) && Contains("best: ") && Contains("profile.json"));
  const auto json = json_of(s.folder.file("out/profile.json"));
  CHECK(json["variants"].size() == 2);
  CHECK(json["proved_rays"] > 100);
  for (const auto& v : json["variants"])
    for (const char* kernel : {"eye", "bounced", "any", "segments", "render"}) {
      const auto& k = v["kernels"][kernel];
      CHECK(k["seconds"].size() == 2);
      CHECK(k["wrong"] == 0);
      CHECK(k["min_seconds"] <= k["median_seconds"]);
      CHECK(k["median_seconds"] <= k["max_seconds"]);
      CHECK(k["rays"] > 0);
      CHECK(k["rays_per_s"] > 0.0);
      CHECK(k["bytes_per_s"] > 0.0);
      CHECK(v["kernels"].count("photons") == 0);
    }
  CHECK(json["skipped"]["photons"] == "no specular material");
  CHECK_THAT(run.out, Contains("photons: not measured: no specular material"));
  const auto trace = json_of(s.folder.file("out/trace.json"));
  std::set<std::string> kernels;
  for (const auto& event : trace["traceEvents"])
    if (event.value("cat", "") == "kernel") kernels.insert(event["name"]);
  CHECK(kernels == std::set<std::string>{"brute_force_closest", "segments_blocked", "shade_pixels", "trace_any_rays",
                                         "trace_closest_rays", "trace_eye_rays", "trace_packets"});
  CHECK_THAT(contents(s.folder.file("out/profile.md")), Contains("| " + best + " |") && Contains("bytes a second"));

  // Whichever of the two was faster here, render takes it and says so.
  const std::string winner = json["winner"];
  REQUIRE_FALSE(s.stored().empty());
  const Run render = s.render();
  REQUIRE(render.code == 0);
  CHECK_THAT(render.err, Contains("variant: " + winner + " (profile of 20"));
  const auto stats = json_of(s.folder.file("s.json"));
  CHECK(stats["variant"]["name"] == winner);
  CHECK_THAT(stats["variant"]["source"].get<std::string>(), Contains("profile of 20"));
  // The scene wins; a damaged file is told of and not used.
  CHECK_THAT(s.render("--set traversal.form=step --set octree.leaf_capacity=9").err, Contains("leaf9"));
  std::filesystem::resize_file(s.stored(), std::filesystem::file_size(s.stored()) / 2);
  const Run damaged = s.render();
  CHECK(damaged.code == 0);
  CHECK_THAT(damaged.err, Contains("it is not used") && Contains("default of"));
}

TEST_CASE("a variant whose kernels are wrong is rejected and never stored", "[long]") {
  const Setting s;
  std::filesystem::copy(POINTGI_SOURCE_DIR "/kernels", s.folder.file("kernels"),
                        std::filesystem::copy_options::recursive);
  const std::string own = "POINTGI_KERNEL_DIR=" + s.folder.file("kernels");
  const auto plant = [&](const std::string& file, const std::string& from, const std::string& to) {
    const std::string path = "kernels/" + file;
    std::string text = contents(s.folder.file(path));
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
    s.folder.write(path, text);
  };
  const std::string arguments = std::string("--rounds 1 --store --filter ") + wide_packet;
  plant("traverse/trace.cl", "answers[i].splat = hit.splat;",
        "answers[i].splat = hit.splat + (TRAVERSAL_FORM == FORM_WIDE && i == 7u ? 1u : 0u);");
  const Run run = s.profile(arguments, own);
  REQUIRE(run.code == 0);
  CHECK_THAT(run.out, Contains(std::string(wide_packet) + ": WRONG: 1 of ") && Contains("bounced rays differ"));
  CHECK_THAT(run.out, Contains(std::string("best: ") + reference));
  const auto json = json_of(s.folder.file("out/profile.json"));
  CHECK(named(json, wide_packet)["wrong"] == true);
  CHECK(named(json, wide_packet)["ranked"] == false);
  CHECK(named(json, wide_packet)["kernels"]["bounced"]["wrong"] == 1);
  CHECK(named(json, reference)["ranked"] == true);
  CHECK(json["winner"] == reference);
  CHECK_THAT(contents(s.stored()), Contains("form = \"step\""));

  // One that does not compile is told of, and the others are measured.
  plant("traverse/trace.cl", "static inline", "#if TRAVERSAL_FORM == FORM_WIDE\nnonsense\n#endif\nstatic inline");
  const Run broken = s.profile(arguments, own);
  CHECK(broken.code == 0);
  CHECK_THAT(broken.out, Contains(std::string(wide_packet) + ": failed:") && Contains("did not compile"));

  // A wrong reference leaves nothing to compare with.
  plant("traverse/trace.cl", "answers[i].t = hit.t;", "answers[i].t = hit.t * 1.001f;");
  const Run nothing = s.profile(arguments, own);
  CHECK(nothing.code == 4);
  CHECK_THAT(nothing.err, Contains("differs from a linear scan"));
}

TEST_CASE("a scene with a mirror has its photons timed, and a variant whose photons end elsewhere is rejected",
          "[long]") {
  const Setting s;
  s.folder.write("ball.toml", mirror_scene());
  const std::string arguments = std::string("--rounds 1 --filter ") + wide_packet;
  REQUIRE(s.profile(arguments).code == 0);
  const auto json = json_of(s.folder.file("out/profile.json"));
  CHECK(json["skipped"].empty());
  for (const char* name : {wide_packet, reference}) {
    const auto& photons = named(json, name)["kernels"]["photons"];
    CHECK(photons["rays"] >= 1024);
    CHECK(photons["wrong"] == 0);
    CHECK(photons["seconds"].size() == 1);
  }
  CHECK_THAT(contents(s.folder.file("out/trace.json")), Contains("\"trace_photons\""));

  std::filesystem::copy(POINTGI_SOURCE_DIR "/kernels", s.folder.file("kernels"),
                        std::filesystem::copy_options::recursive);
  const std::string path = "kernels/photon/trace_photons.cl";
  std::string text = contents(s.folder.file(path));
  const std::string from = "flight->end = end;";
  REQUIRE(text.find(from) != std::string::npos);
  s.folder.write(path, text.replace(text.find(from), from.size(),
                                    "flight->end = TRAVERSAL_FORM == FORM_WIDE ? PHOTON_CUT : end;"));
  const Run run = s.profile(arguments, "POINTGI_KERNEL_DIR=" + s.folder.file("kernels"));
  CHECK(run.code == 0);
  CHECK_THAT(run.out,
             Contains(std::string(wide_packet) + ": WRONG: ") && Contains(" photons differ from the reference"));
}

TEST_CASE("a wrong picture is rejected, though every given ray is answered right", "[long]") {
  const Setting s;
  std::filesystem::copy(POINTGI_SOURCE_DIR "/kernels", s.folder.file("kernels"),
                        std::filesystem::copy_options::recursive);
  const std::string path = "kernels/render/eye_rays.cl";
  std::string text = contents(s.folder.file(path));
  const std::string from = "(float)pixel.x";
  REQUIRE(text.find(from) != std::string::npos);
  s.folder.write(path, text.replace(text.find(from), from.size(), from + " + 1.0f"));
  const Run run =
      s.profile(std::string("--rounds 1 --filter ") + wide_packet, "POINTGI_KERNEL_DIR=" + s.folder.file("kernels"));
  CHECK(run.code == 0);
  CHECK_THAT(run.out, Contains(": WRONG: ") && Contains("picture's eye rays") && !Contains("eye rays differ"));
}

TEST_CASE("one wrong pixel is enough to be rejected", "[long]") {
  const Setting s;
  std::filesystem::copy(POINTGI_SOURCE_DIR "/kernels", s.folder.file("kernels"),
                        std::filesystem::copy_options::recursive);
  const std::string path = "kernels/render/eye_rays.cl";
  std::string text = contents(s.folder.file(path));
  const std::string from = "vstore16(found.splat[2u * k + half_pixel],";
  REQUIRE(text.find(from) != std::string::npos);
  s.folder.write(
      path,
      text.replace(
          text.find(from), from.size(),
          "vstore16(found.splat[2u * k + half_pixel] | (at.x == columns / 2u && at.y == rows / 2u ? NO_SPLAT : 0u),"));
  const Run run = s.profile(std::string("--rounds 1 --store --filter ") + wide_packet,
                            "POINTGI_KERNEL_DIR=" + s.folder.file("kernels"));
  CHECK(run.code == 0);
  CHECK_THAT(run.out, Contains(": WRONG: ") && Contains("picture's eye rays"));
  CHECK_THAT(run.out, Contains("best: step") || Contains("no variant"));
}

TEST_CASE("a filtered profile stores nothing unless it is told to", "[long]") {
  const Setting s;
  const Run run = s.profile(std::string("--rounds 1 --filter ") + reference);
  REQUIRE(run.code == 0);
  CHECK_THAT(run.out, Contains("not stored: --filter"));
  CHECK(s.stored().empty());
  CHECK(json_of(s.folder.file("out/profile.json"))["stored"].is_null());
}

TEST_CASE("profile lists variants, and writes their programs without a device", "[long]") {
  const TemporaryFolder folder;
  const Run list = run_program("profile --list");
  CHECK(list.code == 0);
  CHECK_THAT(list.out, Contains(reference) && Contains(wide_packet) && Contains("packets go through the wide form"));
  CHECK_THAT(list.out, Contains("are valid on this device"));
  CHECK(lines_of(run_program("profile --list --filter wide,leaf64,32x1,hilbert").out).size() <
        lines_of(list.out).size());

  const Run written = run_program("profile --write-programs " + folder.file("programs"), "OCL_ICD_VENDORS=/nowhere");
  REQUIRE(written.code == 0);
  std::size_t count = 0;
  for (const std::string& line : lines_of(contents(folder.file("programs/index.tsv")))) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, '\t');)
      fields.push_back(field);
    CAPTURE(line);
    REQUIRE(fields.size() >= 3); // options may be empty
    CHECK((fields[2] == "cpu,gpu" || fields[2] == "cpu" || fields[2] == "gpu"));
    const std::string source = contents(folder.file("programs/" + fields[0]));
    CHECK_THAT(source, Contains("#line 1 \"kernels/" + fields[1] + "\"") && !Contains("#include \""));
    ++count;
  }
  CHECK(count > 50);
}

TEST_CASE("what is wrong with a profile's options is said before the work") {
  const Setting s;
  const Run nothing = run_program("profile");
  CHECK(nothing.code == 2);
  CHECK_THAT(nothing.err, Contains("scene or cloud"));
  const Run filter = s.profile("--filter wider");
  CHECK(filter.code == 2);
  CHECK_THAT(filter.err, Contains("profile --list"));
  CHECK(run_program("profile " + s.folder.file("none.ply")).code == 3);
  s.folder.write("file", "");
  const Run unwritable = run_program("profile " + s.scene + " -o " + s.folder.file("file/out"));
  CHECK(unwritable.code == 5);
  CHECK_THAT(unwritable.err, !Contains("device:"));
  CHECK(s.profile("--store --no-store").code == 2);
  CHECK(s.profile("--device quantum").code == 4);
}

TEST_CASE("an interrupted profile keeps what was measured and stores nothing", "[long]") {
  const Setting s;
  // Whenever the signal comes within this, rounds are left. --foreground: it comes once.
  const Run run = s.profile(std::string("--rounds 1000 --store --filter ") + reference,
                            "timeout --foreground --preserve-status -s INT 6");
  CHECK(run.code == 130);
  CHECK_THAT(run.err, Contains("interrupted"));
  CHECK(json_of(s.folder.file("out/profile.json"))["interrupted"] == true);
  CHECK(s.stored().empty());
}
