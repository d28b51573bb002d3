#include "host/run.h"
#include "host/stages/prepare.h"
#include "host/stages/stages.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <omp.h>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A cloud without normals: they are estimated, in loops of the host.
std::string bare_points(std::size_t count) {
  std::mt19937 g(1);
  std::normal_distribution<double> coordinate;
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
                     "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p(coordinate(g), coordinate(g), coordinate(g));
    p.normalize();
    text += std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  }
  return text;
}

} // namespace

TEST_CASE("loading a cloud ends wherever it is asked to", "[run]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("bare.ply", bare_points(5000));
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1); // the ranges that a loop's caller takes, and so its questions, depend on the others
  const auto load = [&](int questions) {
    int asked = 0;
    const RunControl control{[&] { return ++asked == questions; }, {}, {}};
    const RunScope scope(control);
    StageLog stages;
    stages.start("cloud");
    Scene scene = load_any(file, {});
    load_and_place(scene, true);
    return asked;
  };
  const int all = load(0);
  CHECK(all > 10); // the start, the reader, and the loops of normals, sides and sizes
  for (const int questions : {1, 2, all / 2, all})
    CHECK_THROWS_WITH(load(questions), "interrupted in the stage cloud; nothing was written");
  CHECK(load(0) == all); // the loops are whole again
  omp_set_num_threads(threads);
}

TEST_CASE("a run hears of stages, progress and log until it ends", "[run]") {
  std::vector<std::string> heard;
  const RunControl control{
      {},
      [&](const StageProgress& p) {
        heard.push_back(p.stage + (p.share ? " " + std::to_string(static_cast<int>(100.0 * *p.share)) + " %" : "") +
                        p.done);
      },
      [&](LogLevel level, const std::string& text) {
        heard.push_back((level == LogLevel::warning ? "warning " : "") + text);
      }};
  log_info("nobody hears {}", 1);
  {
    const RunScope scope(control);
    begin_stage("fmm");
    report_progress(0.5);
    {
      const RunControl silent;
      const RunScope inner(silent);
      begin_stage("image");
      log_warning("nobody hears {}", 2);
    }
    report_progress(std::string(", 3 applies"));
    log_warning("{} is odd", 3);
    CHECK_FALSE(stop_asked());
  }
  log_warning("nobody hears {}", 4);
  CHECK(heard == std::vector<std::string>{"fmm", "fmm 50 %", "fmm, 3 applies", "warning 3 is odd"});
}
