#include "host/cl/embedded_kernels.h"
#include "host/cl/kernel_source.h"
#include "host/error.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

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
