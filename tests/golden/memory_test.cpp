/// What a large cloud takes, on host and device, with light between its surfaces.
#include "tests/support/run_program.h"
#include "tests/support/stats_file.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// Hills of side² points, with normals if wanted.
void write_hills(const std::string& path, std::size_t side, bool normals) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << side * side
       << "\nproperty float x\nproperty float y\nproperty float z\n"
       << (normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "") << "end_header\n";
  const double waves = 40.0, height = 0.01;
  std::vector<float> row;
  for (std::size_t j = 0; j < side; ++j) {
    row.clear();
    for (std::size_t i = 0; i < side; ++i) {
      // Off the grid, by the golden ratio: rows of equal distances are an easy case for sorts and neighbours.
      const double off = std::fmod(0.6180339887 * static_cast<double>(i + side * j), 1.0);
      const double x = (static_cast<double>(i) + 0.5 * off) / static_cast<double>(side);
      const double y = (static_cast<double>(j) + 0.5 * std::fmod(7.0 * off, 1.0)) / static_cast<double>(side);
      const double dx = height * waves * std::cos(waves * x) * std::cos(waves * y);
      const double dy = -height * waves * std::sin(waves * x) * std::sin(waves * y);
      for (const double value : {x, y, height * std::sin(waves * x) * std::cos(waves * y)})
        row.push_back(static_cast<float>(value));
      const double length = std::sqrt(dx * dx + dy * dy + 1.0);
      if (normals)
        for (const double value : {-dx / length, -dy / length, 1.0 / length})
          row.push_back(static_cast<float>(value));
    }
    file.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(float)));
  }
}

/// What a run on the CPU device writes with --stats.
nlohmann::json stats_of_hills(std::size_t side, bool normals, const std::string& settings) {
  const TemporaryFolder folder;
  write_hills(folder.file("hills.ply"), side, normals);
  const std::string scene = folder.write(
      "hills.toml", "version = 1\nup = \"z\"\n[render]\nsize = [64, 48]\nspp = 1\n"
                    "[camera]\nposition = [0.5, -0.7, 0.8]\nlook_at = [0.5, 0.5, 0.0]\nfov_deg = 40.0\n"
                    "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.5, 0.4]\n"
                    "[[cloud]]\nfile = \"hills.ply\"\nmaterial = \"grey\"\n"
                    "[[light]]\ntype = \"directional\"\ndirection = [0.3, 0.2, -1.0]\nirradiance = [3.0, 3.0, 3.0]\n");
  const Run run = run_program("render " + scene + " --quiet -o " + folder.file("x.exr") + " --stats " +
                                  folder.file("stats.json") + " " + settings,
                              "POINTGI_DEVICE=cpu");
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  return json_of(folder.file("stats.json"));
}

} // namespace

TEST_CASE("three million points with radiosity take at most 200 bytes each on the host and 150 on the device",
          "[long]") {
  constexpr std::size_t side = 1733;
  constexpr double points = side * side;
  // Four directions a point: more would only be more hits, of which as many are kept as there is room for.
  const std::string settings = "--set radiosity.method=auto --set radiosity.directions=4 --set radiosity.least_share=0";
  const auto bytes_of = [](const nlohmann::json& stats, const char* key) { return stats["memory"][key].get<double>(); };
  // The program itself, its driver and the compiled kernels.
  stats_of_hills(50, true, settings); // compiles the kernels, which takes more than to use them
  const nlohmann::json small = stats_of_hills(50, true, settings);
  const double program = bytes_of(small, "host_peak_bytes");
  const nlohmann::json stats = stats_of_hills(side, true, settings);
  REQUIRE(stats["scene"]["points"] == side * side);
  REQUIRE(stats["radiosity"]["method"] == "directions");
  const double device = bytes_of(stats, "device_peak_bytes") / points;
  CHECK(device <= 150.0);
  // Until the octree is there, nothing is on the device.
  for (const auto& stage : stats["stages"]) {
    if (stage["name"] != "cloud") continue;
    const double host = (stage["host_peak_bytes"].get<double>() - program) / points;
    CAPTURE(host);
    CHECK(host <= 200.0);
    CHECK(host >= 50.0); // it is counted at all
  }
  // What a CPU device holds is the program's memory, too.
  const double both = (bytes_of(stats, "host_peak_bytes") - program) / points;
  CAPTURE(both, device);
  CHECK(both - device <= 200.0);
}
