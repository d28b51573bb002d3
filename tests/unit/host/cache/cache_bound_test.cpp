/// What is kept between runs has a bound.
#include "host/cache/binary_cache.h"
#include "host/cache/cache_bound.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// Sets a variable of the environment for a while.
class Variable {
public:
  Variable(const char* name, const std::string& value) : name_(name) {
    const char* old = std::getenv(name);
    was_set_ = old != nullptr;
    if (was_set_) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { was_set_ ? setenv(name_, old_.c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

private:
  const char* name_;
  bool was_set_ = false;
  std::string old_;
};

/// A file of `bytes` that was used `minutes` ago.
std::string put(const TemporaryFolder& folder, const std::string& name, std::size_t bytes, int minutes) {
  std::filesystem::create_directories(std::filesystem::path(folder.file(name)).parent_path());
  const std::string path = folder.write(name, std::string(bytes, 'x'));
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - std::chrono::minutes(minutes));
  return path;
}

bool is_there(const std::string& path) {
  return std::filesystem::exists(path);
}

} // namespace

TEST_CASE("of a cache that is too large the files go that were not used for the longest time") {
  const TemporaryFolder folder;
  const std::string oldest = put(folder, "kernels/00000000000000aa.bin", 1000, 50),
                    old = put(folder, "vmaps/00000000000000bb.vmap", 1000, 40),
                    used = put(folder, "kernels/00000000000000cc.bin", 1000, 60),
                    young = put(folder, "vmaps/00000000000000dd.vmap", 1000, 10);
  bound_cache(folder.file(""), 4000);
  CHECK(is_there(used));
  mark_as_used(used);
  bound_cache(folder.file(""), 2999);
  CHECK_FALSE(is_there(oldest));
  CHECK_FALSE(is_there(old));
  CHECK(is_there(used));
  CHECK(is_there(young));
  bound_cache(folder.file(""), 0);
  CHECK_FALSE(is_there(used));
  CHECK_FALSE(is_there(young));
}

TEST_CASE("files that are not kept programs or V-maps are never removed from the cache's folder") {
  const TemporaryFolder folder;
  std::vector<std::string> others;
  for (const char* name :
       {"0123456789abcdef.bin", "profiles/0123456789abcdef.bin", "kernels/thesis.bin", "kernels/0123456789abcdef.txt",
        "kernels/0123456789abcdef.vmap", "kernels/0123456789ABCDEF.bin", "vmaps/0123456789abcdef.bin",
        "vmaps/0123456789abcdefa.vmap", "kernels/0123456789abcdef.bin.tmp", "kernels/deep/0123456789abcdef.bin"})
    others.push_back(put(folder, name, 1000, 1000));
  const std::string target = put(folder, "elsewhere/precious.bin", 1000, 1000),
                    link = folder.file("kernels/00000000000000ee.bin"),
                    directory = folder.file("kernels/00000000000000ff.bin");
  std::filesystem::create_symlink(target, link);
  std::filesystem::create_directory(directory);
  bound_cache(folder.file(""), 0);
  for (const std::string& other : others)
    CHECK(is_there(other));
  CHECK(is_there(target));
  CHECK(is_there(link));
  CHECK(is_there(directory));
  CHECK_NOTHROW(bound_cache(folder.file("none"), 0));
}

TEST_CASE("storing a program keeps the cache within POINTGI_CACHE_BYTES, and loading one marks it as used") {
  const TemporaryFolder folder;
  const Variable where("POINTGI_CACHE_DIR", folder.file("")), most("POINTGI_CACHE_BYTES", "25000");
  const std::vector<unsigned char> binary(10'000, 7); // two fit, three do not
  store_binary("first", binary);
  store_binary("second", binary);
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("kernels"))) // an hour passes
    std::filesystem::last_write_time(entry, entry.last_write_time() - std::chrono::hours(1));
  CHECK(load_binary("first") == binary);
  store_binary("third", binary);
  CHECK_FALSE(load_binary("second"));
  CHECK(load_binary("first"));
  CHECK(load_binary("third"));
}

TEST_CASE("the bound of the cache is a number of bytes, 2 GiB where nobody says one") {
  {
    const Variable most("POINTGI_CACHE_BYTES", "");
    CHECK(most_cache_bytes() == 2147483648u);
  }
  {
    const Variable most("POINTGI_CACHE_BYTES", "5000000000000");
    CHECK(most_cache_bytes() == 5000000000000u);
  }
  for (const char* wrong : {"2G", "-1", " 5", "1e9", "99999999999999999999999"}) {
    const Variable most("POINTGI_CACHE_BYTES", wrong);
    CHECK_THROWS_WITH(most_cache_bytes(), Contains(wrong) && Contains("number of bytes"));
  }
}
