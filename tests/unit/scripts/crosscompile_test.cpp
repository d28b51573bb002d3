// scripts/crosscompile on planted programs: it must pass a good one and name the ones that are bad for GPUs.
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <string>
#include <sys/wait.h>

namespace test = pointgi::test;

namespace {

const char* const good = "__kernel void good(__global float* a) { a[get_global_id(0)] = sqrt(a[get_global_id(0)]); }\n";
const char* const wrong = "__kernel void wrong(__global float* a) { a[0] = no_such_name; }\n";
/// An array that is indexed by what only the run knows stands in memory: 4 kB of it.
const char* const large = "__kernel void large(__global int* a) {\n"
                          "  int waiting[1024];\n"
                          "  for (int i = 0; i < 1024; ++i) waiting[i] = a[i];\n"
                          "  for (int i = 0; i < 1024; ++i) waiting[a[i] & 1023] += a[i + 1];\n"
                          "  a[get_global_id(0)] = waiting[a[0] & 1023];\n"
                          "}\n";
/// Holds 320 numbers at once; a work-item has at most 255 registers on sm_80.
const char* const crowded = "__kernel void crowded(__global float* a, int n) {\n"
                            "  float v[320];\n"
                            "  #pragma unroll\n"
                            "  for (int k = 0; k < 320; ++k) v[k] = a[k * get_global_id(0)];\n"
                            "  for (int i = 0; i < n; ++i) {\n"
                            "    #pragma unroll\n"
                            "    for (int k = 0; k < 320; ++k) v[k] += v[(k + 7) % 320];\n"
                            "  }\n"
                            "  #pragma unroll\n"
                            "  for (int k = 0; k < 320; ++k) a[k] = v[k];\n"
                            "}\n";
const char* const images =
    "__constant sampler_t s = CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_NONE | CLK_FILTER_NEAREST;\n"
    "__kernel void images(__read_only image1d_buffer_t line, __read_only image2d_t sheet,\n"
    "                     __global float4* a) {\n"
    "  const int i = get_global_id(0);\n"
    "  a[i] = read_imagef(line, i) + read_imagef(sheet, s, (int2)(i, 0)) +\n"
    "         convert_float4(read_imageui(line, i) + read_imageui(sheet, s, (int2)(0, i)));\n"
    "}\n";

/// A folder as `pointgi profile --write-programs` makes it.
class Programs {
public:
  void put(const std::string& name, const std::string& text, const std::string& classes) const {
    folder_.write(name, text);
    std::ofstream(folder_.file("index.tsv"), std::ios::app)
        << name << "\tplanted/" << name << "\t" << classes << "\t-cl-std=CL1.2 -D N=1\n";
  }

  std::string table() const { return test::contents(folder_.file("crosscompile.tsv")); }

  /// What the script prints and its exit code.
  std::pair<std::string, int> check(const std::string& environment = "") const {
    const std::string output = folder_.file("output.txt");
    const int status = std::system(("cd / && " + environment + " '" POINTGI_SOURCE_DIR "/scripts/crosscompile' '" +
                                    folder_.file("") + "' > '" + output + "' 2>&1")
                                       .c_str());
    return {test::contents(output), WIFEXITED(status) ? WEXITSTATUS(status) : -1};
  }

private:
  test::TemporaryFolder folder_;
};

bool skipped(const std::string& output) {
  if (output.find("skipped") == std::string::npos) return false;
  WARN("skipped: " << output);
  test::something_skipped = true;
  return true;
}

} // namespace

TEST_CASE("good programs cross-compile, and a large stack frame is a CPU's own affair", "[scripts]") {
  const Programs programs;
  programs.put("000.cl", good, "cpu,gpu");
  programs.put("001.cl", images, "cpu,gpu");
  programs.put("002.cl", large, "cpu");
  const auto [output, code] = programs.check();
  if (skipped(output)) return;
  INFO(output);
  CHECK(code == 0);
  CHECK_THAT(output, Catch::Contains("crosscompile: 3 programs"));
  for (const char* target : {"sm_80", "gfx1030"})
    for (const char* kernel : {"good", "images", "large"})
      CHECK_THAT(programs.table(), Catch::Contains(std::string(kernel) + "\t" + target + "\t"));
}

TEST_CASE("a program that does not compile is named", "[scripts]") {
  const std::string classes = GENERATE("cpu", "gpu");
  const Programs programs;
  programs.put("000.cl", good, "cpu,gpu");
  programs.put("001.cl", wrong, classes);
  const auto [output, code] = programs.check();
  if (skipped(output)) return;
  INFO(output);
  CHECK(code == 1);
  CHECK_THAT(output, Catch::Contains("crosscompile: 001.cl planted/001.cl"));
  CHECK_THAT(output, Catch::Contains("no_such_name"));
  CHECK_THAT(output, !Catch::Contains("crosscompile: 000.cl"));
}

TEST_CASE("a large private array in a program for GPUs is named", "[scripts]") {
  const Programs programs;
  programs.put("000.cl", good, "cpu,gpu");
  programs.put("001.cl", large, "cpu,gpu");
  const auto [output, code] = programs.check();
  if (skipped(output)) return;
  INFO(output);
  CHECK(code == 1);
  CHECK_THAT(output,
             Catch::Contains("crosscompile: 001.cl planted/001.cl -cl-std=CL1.2 -D N=1 for gfx1030: large has a "
                             "stack frame of 4"));
  CHECK_THAT(output, !Catch::Contains("crosscompile: 000.cl"));
}

TEST_CASE("a program for GPUs that spills on sm_80 is named", "[scripts]") {
  const Programs programs;
  programs.put("000.cl", good, "cpu,gpu");
  programs.put("001.cl", crowded, "gpu");
  const auto [output, code] = programs.check();
  if (skipped(output)) return;
  if (output.find("no ptxas") != std::string::npos) {
    WARN("skipped: " << output);
    test::something_skipped = true;
    return;
  }
  INFO(output);
  CHECK(code == 1);
  CHECK_THAT(output, Catch::Contains("for sm_80: crowded spills "));
  CHECK_THAT(output, !Catch::Contains("crosscompile: 000.cl"));
}

TEST_CASE("without libclc cross-compiling says so and passes; without programs it does not", "[scripts]") {
  const Programs programs;
  const auto [output, code] = programs.check("LIBCLC=/nowhere");
  CHECK(code == 0);
  CHECK_THAT(output, Catch::Contains("skipped"));
  const auto [empty_output, empty_code] = programs.check();
  if (skipped(empty_output)) return;
  CHECK(empty_code == 2);
}
