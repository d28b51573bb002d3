// scripts/check/layers on planted trees: it must pass the good one and find every bad include by file and line.
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>

namespace fs = std::filesystem;
namespace test = pointgi::test;

namespace {

/// A small tree with every layer in it, whose includes all follow the arrows.
class Tree {
public:
  Tree() {
    put("kernels/shared/scalar.h", "#ifdef __cplusplus\n#include <cstdint>\n#endif\n");
    put("kernels/shared/types.h", "#include \"shared/scalar.h\"\n");
    put("kernels/lib/rng.h", "#include \"shared/types.h\"\n");
    put("kernels/radiosity/fmm/m2l.cl",
        "#include \"lib/rng.h\"\n#include \"shared/types.h\"\n#include \"radiosity/fmm/m2l_block.h\"\n");
    put("kernels/radiosity/fmm/m2l_block.h", "");
    put("kernels/render/render.cl", "#include \"lib/rng.h\"\n");
    put("octree/build/tree.h", "#include \"shared/types.h\"\n#include <vector>\n");
    put("fmm/lists/lists.h", "#include \"octree/build/tree.h\"\n#include \"shared/types.h\"\n");
    put("host/error.h", "#include <string>\n");
    put("host/cl/device.h", "#include \"host/error.h\"\n#include <CL/opencl.hpp>\n");
    put("host/cloud/readers/ply.h", "#include \"host/error.h\"\n#include \"octree/build/tree.h\"\n");
    put("host/image/srgb.h", "#include \"host/error.h\"\n");
    put("host/scene/scene.h", "#include \"host/cloud/readers/ply.h\"\n#include \"host/image/srgb.h\"\n");
    put("host/passes/run.h", "#include \"host/cl/device.h\"\n#include \"host/scene/scene.h\"\n"
                             "#include \"fmm/lists/lists.h\"\n  #  include \"shared/types.h\"\n");
    put("host/photon/plan.h", "#include \"host/passes/run.h\"\n");
    put("host/app/main.cpp", "#include \"host/passes/run.h\"\n#include <CLI/CLI.hpp>\n");
    put("tests/support/scans.h", "#include \"host/app/main.cpp\"\n#include <CL/cl.h>\n");
    put("tests/unit/scans_test.cpp", "#include \"tests/support/scans.h\"\n");
  }
  void put(const std::string& file, const std::string& text) const {
    fs::create_directories(fs::path(folder_.file(file)).parent_path());
    folder_.write(file, text);
  }

  /// What the script prints and its exit code.
  std::pair<std::string, int> check() const {
    const std::string output = folder_.file("output.txt");
    const int status = std::system(
        ("cd / && '" POINTGI_SOURCE_DIR "/scripts/check/layers' '" + folder_.file("") + "' > '" + output + "' 2>&1")
            .c_str());
    return {test::contents(output), WIFEXITED(status) ? WEXITSTATUS(status) : -1};
  }

private:
  test::TemporaryFolder folder_;
};

struct BadInclude {
  const char *file, *include;
};

} // namespace

TEST_CASE("a tree whose includes follow the arrows passes", "[scripts]") {
  const Tree tree;
  const auto [output, code] = tree.check();
  INFO(output);
  CHECK(code == 0);
  CHECK_THAT(output, Catch::StartsWith("layers: all "));
}

TEST_CASE("an include against the arrows is found by file and line", "[scripts]") {
  const BadInclude bad = GENERATE(
      BadInclude{"kernels/shared/bad.h", "\"lib/rng.h\""}, BadInclude{"kernels/shared/bad.h", "\"host/error.h\""},
      BadInclude{"kernels/lib/bad.h", "\"radiosity/fmm/m2l_block.h\""},
      BadInclude{"kernels/render/bad.cl", "\"radiosity/fmm/m2l.cl\""},
      BadInclude{"kernels/render/bad.cl", "\"octree/build/tree.h\""}, BadInclude{"octree/build/bad.h", "\"lib/rng.h\""},
      BadInclude{"octree/bad.cpp", "\"fmm/lists/lists.h\""}, BadInclude{"octree/bad.cpp", "\"host/error.h\""},
      BadInclude{"fmm/bad.cpp", "\"host/error.h\""}, BadInclude{"fmm/bad.cpp", "<CL/cl.h>"},
      BadInclude{"fmm/bad.cpp", "\"tests/support/scans.h\""}, BadInclude{"host/bad.h", "\"host/cloud/readers/ply.h\""},
      BadInclude{"host/cloud/bad.h", "\"host/scene/scene.h\""}, BadInclude{"host/cloud/bad.h", "\"host/image/srgb.h\""},
      BadInclude{"host/scene/bad.h", "\"host/photon/plan.h\""},
      BadInclude{"host/passes/bad.h", "\"host/photon/plan.h\""},
      BadInclude{"host/cl/bad.h", "\"host/cloud/readers/ply.h\""},
      BadInclude{"host/image/bad.h", "\"host/scene/scene.h\""}, BadInclude{"host/image/bad.h", "<octree/build/tree.h>"},
      BadInclude{"host/passes/bad.cpp", "\"host/app/main.cpp\""}, BadInclude{"host/passes/bad.cpp", "<CL/opencl.hpp>"},
      BadInclude{"host/stages/bad.h", "\"host/app/main.cpp\""}, BadInclude{"host/api/bad.h", "\"host/app/main.cpp\""},
      BadInclude{"host/passes/bad.cpp", "\"tests/support/scans.h\""}, BadInclude{"host/passes/bad.cpp", "\"run.h\""},
      BadInclude{"host/passes/bad.cpp", "\"../error.h\""}, BadInclude{"host/new/bad.cpp", "\"host/error.h\""});
  const Tree tree;
  tree.put(bad.file, std::string("#include <vector>\n\n#include ") + bad.include + "\n");
  const auto [output, code] = tree.check();
  INFO(bad.file << " includes " << bad.include << "\n" << output);
  CHECK(code == 1);
  CHECK_THAT(output, Catch::StartsWith(std::string(bad.file) + ":3: "));
  CHECK_THAT(output, Catch::Contains("layers: 1 of "));
}

TEST_CASE("a folder without sources is not called good", "[scripts]") {
  const std::string nowhere = "'" POINTGI_SOURCE_DIR "/scripts/check/layers' /nowhere/at/all > /dev/null 2>&1";
  const int status = std::system(nowhere.c_str());
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 2);
}
