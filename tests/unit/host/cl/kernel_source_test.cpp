#include "host/cl/embedded_kernels.h"
#include "host/cl/kernel_source.h"
#include "host/error.h"
#include "host/tune/variant_list.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <set>

using namespace pointgi;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++n;
  return n;
}

} // namespace

TEST_CASE("a kernel source holds each included file once, with markers and no #include left") {
  const std::string source = kernel_source("render/shade.cl");
  CHECK(count(source, "#include \"") == 0);
  CHECK(count(source, "inline float dot3(") == 1);
  CHECK(count(source, "#line 1 \"kernels/lib/vector.cl\"") == 1);
  CHECK(source.rfind("#line 1 \"kernels/render/shade.cl\"", 0) == 0);
}

TEST_CASE("markers count the lines of our files") {
  // Behind each marker, the named line of the named file must follow.
  const std::string source = kernel_source("render/shade.cl");
  const std::string marker = "#line ";
  int checked = 0;
  for (std::size_t at = source.find(marker); at != std::string::npos; at = source.find(marker, at + 1)) {
    const int line = std::atoi(source.c_str() + at + marker.size());
    const std::size_t quote = source.find('"', at) + 1, end = source.find('"', quote),
                      next = source.find('\n', end) + 1;
    const std::string name = source.substr(quote, end - quote).substr(std::string("kernels/").size());
    const std::string following = source.substr(next, source.find('\n', next) - next);
    if (following.rfind(marker, 0) == 0) continue; // two includes in a row
    std::ifstream file(POINTGI_SOURCE_DIR "/kernels/" + name);
    std::string text;
    for (int i = 0; i < line; ++i)
      std::getline(file, text);
    CAPTURE(name, line);
    CHECK(text == following);
    ++checked;
  }
  CHECK(checked > 10);
}

TEST_CASE("a missing kernel file is named") {
  CHECK_THROWS_WITH(kernel_source("render/none.cl"), Catch::Contains("render/none.cl"));
}

TEST_CASE("a file that is included inside a conditional first, and outside later, is refused") {
  const pointgi::test::TemporaryFolder folder;
  folder.write("inner.cl", "int inner;\n");
  folder.write("bad.cl", "#ifdef A\n#include \"inner.cl\"\n#endif\n#include \"inner.cl\"\n");
  folder.write("good.cl", "#include \"inner.cl\"\n#ifdef A\n#include \"inner.cl\"\n#endif\n");
  folder.write("guarded.cl", "#ifndef POINTGI_X\n#include \"inner.cl\"\n#endif\n#include \"inner.cl\"\n");
  setenv("POINTGI_KERNEL_DIR", folder.file("").c_str(), 1);
  CHECK_THROWS_WITH(kernel_source("bad.cl"),
                    Catch::Contains("bad.cl:4") && Catch::Contains("include it outside, before both"));
  folder.write("branches.cl", "#ifdef A\n#include \"inner.cl\"\n#else\n#include \"inner.cl\"\n#endif\n");
  CHECK_THROWS_WITH(kernel_source("branches.cl"), Catch::Contains("branches.cl:4"));
  CHECK(count(kernel_source("good.cl"), "int inner;") == 1);
  CHECK_NOTHROW(kernel_source("guarded.cl"));
  unsetenv("POINTGI_KERNEL_DIR");
}

TEST_CASE("no program includes a file inside a conditional that it needs outside") {
  std::set<std::string> files;
  for (const ProgramUse& use : all_programs())
    files.insert(use.program.file);
  CHECK(files.size() > 10);
  for (const std::string& file : files)
    CHECK_NOTHROW(kernel_source(file));
}
