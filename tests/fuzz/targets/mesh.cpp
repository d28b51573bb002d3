/// A mesh in a file of the extension POINTGI_FUZZ_TARGET: points with an area each, or an input error.
#include "host/cloud/readers/mesh.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/promises.h"

using namespace pointgi;
using namespace pointgi::test;

/// Assimp's importers keep what they have made of a file that they then refuse; only the library can free it.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp.so";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = write_input("input." POINTGI_FUZZ_TARGET, view_of(data, size));
  // So coarse that few points come of the largest triangles that floats can make: how meshes are read is looked for.
  constexpr double spacing = 1e38;
  CloudReport report;
  try {
    const PointCloud cloud = sample_mesh(path, spacing, report);
    require_kept(broken_promise(cloud, report));
    require_kept(cloud.area.size() == cloud.size() ? "" : "points without an area");
  } catch (const Error& error) {
    require_kept(broken_promise(error, path));
  }
  return 0;
}
