#include "host/error.h"
#include "host/tune/tuned.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// A cache folder of the test's own while it lives.
class OwnCache {
public:
  OwnCache() {
    if (const char* value = std::getenv("POINTGI_CACHE_DIR")) before_ = value;
    setenv("POINTGI_CACHE_DIR", folder_.file("cache").c_str(), 1);
  }
  ~OwnCache() { setenv("POINTGI_CACHE_DIR", before_.c_str(), 1); }
  OwnCache(const OwnCache&) = delete;
  OwnCache& operator=(const OwnCache&) = delete;

private:
  TemporaryFolder folder_;
  std::string before_;
};

DeviceInfo some_cpu() {
  DeviceInfo info = ideal_device(true);
  info.name = "pthread \"quoted\" CPU 3 GHz";
  info.platform = "A platform";
  info.driver = "3.1";
  info.opencl = "OpenCL 1.2 driver HSTR: x";
  return info;
}

TraversalVariant other_wide() {
  TraversalVariant v = plain_variant(TraversalForm::wide);
  v.lanes = 16;
  v.leaf_capacity = 128;
  v.group = {64, 1};
  return v;
}

} // namespace

TEST_CASE("the defaults of both classes are valid there") {
  for (const bool cpu : {true, false}) {
    const VariantChoice choice = choose_variant({}, {}, ideal_device(cpu));
    CHECK_THAT(choice.source, Contains(cpu ? "default of CPU devices" : "default of GPUs"));
    CHECK(choice.variant.form == (cpu ? TraversalForm::wide : TraversalForm::step));
    CHECK_FALSE(choice.variant.fast_math);
  }
}

TEST_CASE("the scene wins over a profile, a profile over the defaults") {
  const OwnCache cache;
  const DeviceInfo device = some_cpu();
  CHECK_FALSE(stored_winner(device).file);
  const std::string path = store_winner(device, other_wide(), "bunny.ply", 4.5e6);
  const StoredWinner stored = stored_winner(device);
  REQUIRE(stored.file);
  CHECK(stored.warning.empty());
  CHECK(stored.file->device == "pthread \"quoted\" CPU 3 GHz (A platform)");
  CHECK(stored.file->rays_per_second == Approx(4.5e6));

  const VariantChoice tuned = choose_variant({}, {}, device, stored.file);
  CHECK(name_of(tuned.variant) == name_of(other_wide()));
  CHECK_THAT(tuned.source, Contains("profile of 20"));

  OctreeSettings octree;
  octree.leaf_capacity = 7;
  const VariantChoice both = choose_variant({}, octree, device, stored.file);
  CHECK(both.variant.leaf_capacity == 7);
  CHECK(both.variant.lanes == 16);
  CHECK_THAT(both.source, Contains("the scene and profile of 20"));

  // What does not go with the scene's settings is passed over whole: no leaf size of another form.
  TraversalSettings traversal;
  traversal.storage = PoolStorage::image2d;
  const VariantChoice plain = choose_variant(traversal, {}, device, stored.file);
  CHECK(plain.variant.form == TraversalForm::step);
  CHECK(plain.variant.leaf_capacity == plain_variant(TraversalForm::step).leaf_capacity);
  CHECK(plain.variant.storage == PoolStorage::image2d);
  CHECK_THAT(plain.source, Contains("the scene and plain step form"));
}

TEST_CASE("settings that do not go together are refused with the precondition") {
  TraversalSettings traversal;
  traversal.form = TraversalForm::wide;
  OctreeSettings octree;
  octree.branching = 4;
  try {
    choose_variant(traversal, octree, some_cpu());
    FAIL("not refused");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::usage);
    CHECK_THAT(error.what(), Contains("the wide form takes N = 2") && Contains("leave them out"));
  }
  traversal = {};
  traversal.grouping = RayGrouping::packet;
  CHECK_NOTHROW(choose_variant(traversal, {}, some_cpu()));
  CHECK_THROWS_WITH(choose_variant(traversal, {}, ideal_device(false)), Contains("CPU device"));
}

TEST_CASE("a stored winner that is damaged or foreign is ignored with a warning") {
  const OwnCache cache;
  const DeviceInfo device = some_cpu();
  const std::string path = store_winner(device, other_wide(), "bunny.ply", 4.5e6), whole = contents(path);
  REQUIRE(stored_winner(device).file);
  const auto with = [&](const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
    const StoredWinner stored = stored_winner(device);
    return stored.file ? std::string("(used)") : stored.warning;
  };
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    REQUIRE(text.find(from) != std::string::npos);
    return text.replace(text.find(from), from.size(), to);
  };
  CHECK(with(whole) == "(used)");
  for (std::size_t size = 0; size + 2 < whole.size(); size += 7) { // cut short anywhere
    CAPTURE(size);
    CHECK(with(whole.substr(0, size)) != "(used)");
  }
  CHECK_THAT(with(replaced("A platform", "B platform")), Contains("another device or driver"));
  CHECK_THAT(with(replaced("version = \"", "version = \"99.")), Contains("pointgi 99."));
  CHECK_THAT(with(replaced("form = \"wide\"", "form = \"tall\"")), Contains("traversal.form"));
  CHECK_THAT(with(replaced("storage = \"buffer\"", "storage = \"image2d\"")), Contains("plain buffers"));
  CHECK_THAT(with(replaced("lanes = 16", "lanes = 16\nfast_math = true")), Contains("no approximation"));
  CHECK_THAT(with(replaced("lanes = 16", "lanes = 16\nmagic = 1")), Contains("unknown key"));
  CHECK_THAT(with(std::string(1000, '\0')), Contains("not used"));
}

TEST_CASE("another device or driver has another winner") {
  const OwnCache cache;
  DeviceInfo a = some_cpu(), b = some_cpu();
  b.driver = "3.2";
  store_winner(a, other_wide(), "x", 1.0);
  CHECK(winner_path(a) != winner_path(b));
  CHECK_FALSE(stored_winner(b).file);
}
