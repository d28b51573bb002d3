/// An environment map in a file of the extension POINTGI_FUZZ_TARGET: a map with its tables, or an input error.
#include "host/lights/environment_map.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/promises.h"
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

std::string broken_promise(const EnvironmentMap& map) {
  const auto width = static_cast<std::size_t>(map.width), height = static_cast<std::size_t>(map.height);
  if (map.width < 1 || map.height < 1) return "the map is empty";
  if (map.texels.size() != width * height || map.columns.size() != width * height || map.rows.size() != height)
    return "a table has another size than the map";
  for (const SkyTexel& texel : map.texels) {
    if (!(texel.density >= 0.0f) || !std::isfinite(texel.density)) return "a density is no density";
    for (const float value : texel.radiance)
      if (!(value >= 0.0f) || !std::isfinite(value)) return "a radiance is no radiance";
  }
  if (map.rows.back().cumulative != 1.0f) return "the shares of the rows do not end in 1";
  for (std::size_t y = 0; y < height; ++y)
    if (map.columns[(y + 1) * width - 1] != 1.0f) return "the shares of a row do not end in 1";
  return {};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = write_input("input." POINTGI_FUZZ_TARGET, view_of(data, size));
  try {
    require_kept(broken_promise(load_environment_map(path, sky_frame(UpAxis::z, 30.0), 2.0)));
  } catch (const Error& error) {
    require_kept(test::broken_promise(error, path));
  }
  return 0;
}
