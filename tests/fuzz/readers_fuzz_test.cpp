/// Damaged files of every format: whatever the bytes, the reader returns a cloud that the file can account for, or
/// throws an input error that says where; and it takes no more memory than the file accounts for.
/// POINTGI_FUZZ=100000 in the environment: so many mutations of each seed.
#include "host/cloud/readers/readers.h"
#include "tests/fuzz/allocations.h"
#include "tests/fuzz/cloud_seeds.h"
#include "tests/support/mutator.h"
#include "tests/support/survives.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <set>

using namespace pointgi;
using namespace pointgi::test;

namespace {

const CloudReader& reader_of(const CloudSeed& seed) {
  const auto& readers = cloud_readers();
  const auto found =
      std::find_if(readers.begin(), readers.end(), [&](const auto& reader) { return seed.format == reader.format; });
  REQUIRE(found != readers.end());
  return *found;
}

std::string packed(const CloudSeed& seed, const std::string& bytes) {
  return seed.pack ? seed.pack(bytes) : bytes;
}

/// Reads the file; fails the test unless the outcome is one of the two that are allowed. True when it was a cloud.
bool survives(const CloudSeed& seed, const CloudReader& reader, const std::string& path, std::size_t file_bytes) {
  // A point takes three bytes at least: a digit a coordinate.
  const double bytes_each = 3.0 / static_cast<double>(seed.expansion);
  const std::size_t before = allocated_bytes();
  reset_peak();
  const bool is_cloud = test::survives(reader.read, path, file_bytes, bytes_each);
  // The file itself, and for each of its bytes at most a double of each field of a point, of which a row of text has
  // a value for every two bytes; the rest is what texts, tables and threads take for any file.
  REQUIRE(peak_bytes() - before <= (std::size_t{8} << 20) + 512 * file_bytes * seed.expansion);
  return is_cloud;
}

/// 0, -1, 2^31, 2^63, and one too many, as digits or as bytes.
std::vector<std::string> nasty_counts(const std::string& bytes, const CountPlace& place) {
  if (place.digits)
    return {"0", "-1", "2147483648", "4294967296", "9223372036854775808", "1" + bytes.substr(place.byte, place.bytes)};
  std::vector<std::string> values;
  for (const std::uint64_t value : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{1} << 31, std::uint64_t{1} << 63,
                                    std::uint64_t{0x7fffffff}, std::uint64_t{1} << (8 * place.bytes - 1)}) {
    std::string little(place.bytes, '\0');
    for (std::size_t k = 0; k < place.bytes; ++k)
      little[k] = static_cast<char>(value >> (8 * k));
    values.push_back(little);
  }
  return values;
}

int wanted_mutations() {
  const char* text = std::getenv("POINTGI_FUZZ");
  return text == nullptr ? 200 : std::max(1, std::atoi(text));
}

} // namespace

TEST_CASE("readers fuzz: every format that is read has a sound seed") {
  const TemporaryFolder folder;
  std::set<std::string> seeded;
  for (const CloudSeed& seed : cloud_seeds()) {
    INFO(seed.format << " " << seed.extension);
    seeded.insert(seed.format);
    CloudReport report;
    const std::string path = folder.write("seed" + seed.extension, packed(seed, seed.bytes));
    const PointCloud cloud = reader_of(seed).read(path, {0.0, {}, true}, report);
    CHECK(cloud.size() == seed.points);
    CHECK(read_cloud(path, {}, report).size() == seed.points); // which finds the same reader
  }
  for (const CloudReader& reader : cloud_readers()) {
    INFO(reader.format);
    CHECK((reader.read == nullptr || seeded.count(reader.format) == 1));
  }
}

TEST_CASE("readers fuzz: truncation at a hundred places") {
  const TemporaryFolder folder;
  for (const CloudSeed& seed : cloud_seeds()) {
    INFO(seed.format << " " << seed.extension);
    const CloudReader& reader = reader_of(seed);
    const std::string whole = packed(seed, seed.bytes);
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 100);
    for (std::size_t length = 0; length < whole.size(); length += step) {
      INFO("length " << length);
      survives(seed, reader, folder.write("cut" + seed.extension, whole.substr(0, length)), length);
      // And what was cut before it was packed.
      const std::string inner = packed(seed, seed.bytes.substr(0, std::min(length, seed.bytes.size())));
      survives(seed, reader, folder.write("cut" + seed.extension, inner), inner.size());
    }
  }
}

TEST_CASE("readers fuzz: counts that lie") {
  const TemporaryFolder folder;
  for (const CloudSeed& seed : cloud_seeds()) {
    INFO(seed.format << " " << seed.extension);
    const CloudReader& reader = reader_of(seed);
    for (const CountPlace& place : seed.counts)
      for (const std::string& count : nasty_counts(seed.bytes, place)) {
        INFO("byte " << place.byte << ", count " << count);
        std::string bytes = seed.bytes;
        bytes.replace(place.byte, place.bytes, count);
        const std::string file = packed(seed, bytes);
        survives(seed, reader, folder.write("count" + seed.extension, file), file.size());
      }
  }
}

TEST_CASE("readers fuzz: mutations") {
  const TemporaryFolder folder;
  const int mutations = wanted_mutations();
  for (const CloudSeed& seed : cloud_seeds()) {
    INFO(seed.format << " " << seed.extension);
    const CloudReader& reader = reader_of(seed);
    int clouds = 0;
    for (int i = 0; i < mutations; ++i) {
      INFO("mutation " << i);
      const Mutator mutate(static_cast<std::uint32_t>(i), seed.end_of_header);
      // Half of the damage to packed files lies inside, where checksums are right.
      const bool outside = seed.pack != nullptr && i % 2 == 0;
      const std::string file =
          outside ? Mutator(mutate)(packed(seed, seed.bytes)) : packed(seed, Mutator(mutate)(seed.bytes));
      clouds += survives(seed, reader, folder.write("mutated" + seed.extension, file), file.size());
    }
    // Both outcomes must have been met, else the fuzz tests one half of the reader only.
    CHECK(clouds > mutations / 100);
    CHECK(clouds < mutations);
    if (mutations > 10000)
      WARN(seed.format << " " << seed.extension << ": " << mutations << " mutations, " << clouds << " clouds");
  }
}
