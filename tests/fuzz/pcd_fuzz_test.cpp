/// Damaged PCD files: whatever the bytes, read_pcd() returns a cloud that the file can account for or throws an input
/// error that says where.
#include "host/cloud/readers/lzf.h"
#include "host/cloud/readers/pcd_read.h"
#include "tests/support/lzf_bytes.h"
#include "tests/support/mutator.h"
#include "tests/support/ply_bytes.h"
#include "tests/support/survives.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// Small files with everything that the reader knows, one a kind of data.
std::vector<std::string> seed_files() {
  const std::string head = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb _ pair\nSIZE 4 4 4 4 1 2\nTYPE F F F F U I\n"
                           "COUNT 1 1 1 1 3 2\nWIDTH 4\nHEIGHT 2\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 8\nDATA ";
  std::string text, records, columns[6];
  for (int i = 0; i < 8; ++i) {
    const auto value = static_cast<float>(i);
    const std::string fields[6]{bytes_of(value), bytes_of(-value),
                                bytes_of(0.5f),  "\1\2\3\4",
                                "abc",           bytes_of(static_cast<std::int16_t>(i)) + bytes_of<std::int16_t>(-1)};
    for (std::size_t f = 0; f < 6; ++f) {
      records += fields[f];
      columns[f] += fields[f];
    }
    text += std::to_string(i) + " -" + std::to_string(i) + " nan 4278190335 1 2 3 " + std::to_string(i) + " -1\n";
  }
  std::string block;
  for (const std::string& column : columns)
    block += column;
  const std::string packed = lzf_compressed(block);
  return {head + "ascii\n" + text, head + "binary\n" + records,
          head + "binary_compressed\n" + bytes_of(static_cast<std::uint32_t>(packed.size())) +
              bytes_of(static_cast<std::uint32_t>(block.size())) + packed};
}

/// A point of x y z in single bytes could come out of 3/88 bytes of compressed ones.
bool is_cloud(const std::string& path, std::size_t file_size) {
  return survives(read_pcd, path, file_size, 3.0 / lzf_most);
}

} // namespace

TEST_CASE("pcd fuzz: truncation at every byte") {
  const TemporaryFolder folder;
  for (const std::string& seed : seed_files()) {
    CHECK(is_cloud(folder.write("whole.pcd", seed), seed.size()));
    const bool ascii = seed.find("DATA ascii") != std::string::npos;
    for (std::size_t length = 0; length < seed.size(); ++length) {
      INFO("length " << length);
      // Text is complete without its last line end; its last number can be shorter.
      const bool may_do = ascii && length + 2 >= seed.size();
      const bool cloud = is_cloud(folder.write("cut.pcd", seed.substr(0, length)), length);
      CHECK((!cloud || may_do));
    }
  }
}

TEST_CASE("pcd fuzz: thousands of mutations") {
  const TemporaryFolder folder;
  std::uint32_t number = 0;
  for (const std::string& seed : seed_files()) {
    std::size_t clouds = 0;
    for (int i = 0; i < 2000; ++i) {
      const std::uint32_t random_seed = ++number;
      INFO("mutation " << random_seed);
      const std::string bytes = Mutator(random_seed, "\nDATA")(seed);
      clouds += is_cloud(folder.write("mutated.pcd", bytes), bytes.size());
    }
    // Both outcomes must have been met, else the fuzz tests one half of the reader only.
    CHECK(clouds > 20);
    CHECK(clouds < 1980);
  }
}
