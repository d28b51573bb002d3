/// Damaged files of Gaussians.
#include "host/cloud/readers/gaussian_files.h"
#include "tests/support/damaged.h"
#include "tests/support/gaussian_bytes.h"

using namespace pointgi;
using namespace pointgi::test;

namespace {

const std::vector<TestGaussian>& gaussians() {
  static const std::vector<TestGaussian> few = some_gaussians(300);
  return few;
}

} // namespace

TEST_CASE("gaussian fuzz: truncation") {
  CHECK(count_clouds_of_truncations(read_spz, spz_bytes(gaussians(), 3, 1), 1) == 0);
  CHECK(count_clouds_of_truncations(read_compressed_ply, compressed_ply_bytes(gaussians(), true, false), 16) == 0);
  // Without a header every 32nd byte ends a file that is whole.
  CHECK(count_clouds_of_truncations(read_splat, splat_bytes(gaussians()), 32) > 0);
}

TEST_CASE("gaussian fuzz: thousands of mutations") {
  const std::size_t splats = count_clouds_of_mutations(read_splat, splat_bytes(gaussians()), 32, 2000);
  CHECK(splats > 20);
  CHECK(splats < 1980);
  const std::size_t packed = count_clouds_of_mutations(
      read_compressed_ply, compressed_ply_bytes(gaussians(), true, false), 16, 2000, "end_header");
  CHECK(packed > 20);
  CHECK(packed < 1980);
  // The check sum finds nearly every change of the packed bytes.
  count_clouds_of_mutations(read_spz, spz_bytes(gaussians(), 3, 1), 1, 2000);
}

TEST_CASE("gaussian fuzz: SPZ that was damaged before it was packed") {
  const std::string seed = spz_unpacked(gaussians(), 3, 1);
  const TemporaryFolder folder;
  std::size_t clouds = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    INFO("mutation " << i);
    std::string bytes = Mutator(i)(seed);
    if (i % 2 == 0 && bytes.size() > 16) bytes[i % 16] = static_cast<char>(i / 16); // the header is where it matters
    clouds += survives(read_spz, folder.write("mutated", gzipped(bytes)), bytes.size(), 1);
  }
  CHECK(clouds > 20);
  CHECK(clouds < 1980);
  for (const std::uint32_t count : {0u, 2147483648u, 4294967295u}) {
    const std::string path = folder.write("count", gzipped(std::string(seed).replace(8, 4, bytes_of(count))));
    CHECK_FALSE(survives(read_spz, path, seed.size(), 1));
  }
}
