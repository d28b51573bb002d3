#include "host/atomic_file.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace pointgi;
using Catch::Matchers::Contains;
using pointgi::test::contents;
using pointgi::test::TemporaryFolder;

namespace {

/// Root may write everywhere: while this lives, the test is done as "nobody". No change for other users.
struct WithoutRoot {
  WithoutRoot() { REQUIRE((!root || ::seteuid(65534) == 0)); }
  ~WithoutRoot() {
    if (root && ::seteuid(0) != 0) std::abort();
  }
  const bool root = ::geteuid() == 0;
};

Error error_of_opening(const std::string& path) {
  try {
    AtomicFile file(path);
  } catch (const Error& error) {
    return error;
  }
  FAIL("no error for " << path);
  throw;
}

} // namespace

TEST_CASE("atomic file: nothing is seen before commit and all of it afterwards") {
  TemporaryFolder folder;
  const std::string path = folder.write("a.bin", "old");
  {
    AtomicFile file(path);
    file.write("new content", 11);
    CHECK(contents(path) == "old");
    CHECK(std::filesystem::path(file.temporary_path()).parent_path() == std::filesystem::path(path).parent_path());
    CHECK(contents(file.temporary_path()) == "new content");
    file.commit();
    CHECK(contents(path) == "new content");
  }
  CHECK(contents(path) == "new content");
  CHECK(folder.entries() == 1);
}

TEST_CASE("atomic file: what is committed without waiting for the disk replaces the old file all the same") {
  const TemporaryFolder folder;
  const std::string target = folder.write("x.kept", "old");
  {
    AtomicFile file(target);
    file.write("new", 3);
    CHECK(contents(target) == "old");
    file.commit_unsynced();
    CHECK_THROWS_WITH(file.commit_unsynced(), Contains("committed twice"));
  }
  CHECK(contents(target) == "new");
  CHECK(folder.entries() == 1);
}

TEST_CASE("atomic file: what killed runs have left of it is removed, and nothing else") {
  const TemporaryFolder folder;
  const std::string target = folder.file("x.exr");
  folder.write(".x.exr.123.0a1b2c3d.tmp", "half");
  for (const char* other : {".x.exr.y.123.0a1b2c3d.tmp", "x.exr", ".xx.exr.1.2.tmp", ".x.exr.tmp", "x.exr.1.2.tmp"})
    folder.write(other, "another");
  remove_unfinished(target);
  CHECK_FALSE(std::filesystem::exists(folder.file(".x.exr.123.0a1b2c3d.tmp")));
  CHECK(folder.entries() == 5);
  remove_unfinished(folder.file("no/such/folder"));
}

TEST_CASE("atomic file: without commit the old file stays and the temporary goes") {
  TemporaryFolder folder;
  const std::string path = folder.write("a.bin", "old");
  {
    AtomicFile file(path);
    file.write("new", 3);
  }
  CHECK(contents(path) == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("atomic file: a library may write by name instead") {
  TemporaryFolder folder;
  AtomicFile file(folder.file("a.bin"));
  std::ofstream(file.temporary_path(), std::ios::binary) << "by name";
  file.commit();
  CHECK(contents(folder.file("a.bin")) == "by name");
}

TEST_CASE("atomic file: permissions come from the umask or from the file that is replaced") {
  TemporaryFolder folder;
  const auto mode_of = [](const std::string& path) {
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    return status.st_mode & 0777u;
  };
  const mode_t old_mask = ::umask(027);
  AtomicFile fresh(folder.file("fresh"));
  fresh.commit();
  ::umask(old_mask);
  CHECK(mode_of(folder.file("fresh")) == 0640u);

  const std::string secret = folder.write("secret", "x");
  REQUIRE(::chmod(secret.c_str(), 0600) == 0);
  AtomicFile again(secret);
  again.commit();
  CHECK(mode_of(secret) == 0600u);
}

TEST_CASE("atomic file: a symbolic link stays one and its target is replaced") {
  TemporaryFolder folder;
  const std::string target = folder.write("target", "old");
  std::filesystem::create_symlink(target, folder.file("link"));
  AtomicFile file(folder.file("link"));
  file.write("new", 3);
  file.commit();
  CHECK(contents(target) == "new");
  CHECK(std::filesystem::is_symlink(folder.file("link")));
}

TEST_CASE("atomic file: places that cannot be written are output errors with a remedy") {
  TemporaryFolder folder;
  const std::string plain = folder.write("plain", "x");
  REQUIRE(::mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  struct Case {
    std::string path, says;
  };
  const std::vector<Case> cases{
      {folder.file("missing/a.exr"), "create the folder"},
      {plain + "/a.exr", "create the folder"},
      {folder.file(""), "not the name of a file"},
      {folder.file(".."), "Is a directory"},
      {"", "not the name of a file"},
      {"/dev/full", "device"},
      {folder.file("pipe"), "pipe"},
      {folder.file(std::string(300, 'n')), "shorter name"},
  };
  for (const Case& c : cases) {
    const Error error = error_of_opening(c.path);
    CHECK(error.kind() == ErrorKind::output);
    CHECK_THAT(error.what(), Contains(c.path) && Contains(c.says));
  }
  CHECK(::access("/dev/full", F_OK) == 0);
  CHECK(contents(plain) == "x");
}

TEST_CASE("atomic file: a folder or file without write permission is an output error") {
  TemporaryFolder folder;
  ::chmod(folder.file("").c_str(), 0755);
  const std::string locked = folder.write("locked", "x");
  ::chmod(locked.c_str(), 0444);
  std::filesystem::create_directory(folder.file("read_only"));
  ::chmod(folder.file("read_only").c_str(), 0555);
  {
    const WithoutRoot plain_user;
    CHECK_THAT(error_of_opening(locked).what(), Contains(locked) && Contains("write-protected"));
    const Error error = error_of_opening(folder.file("read_only/a"));
    CHECK(error.kind() == ErrorKind::output);
    CHECK_THAT(error.what(), Contains(folder.file("read_only")) && Contains("you may write to"));
  }
  ::chmod(folder.file("read_only").c_str(), 0755);
  CHECK(contents(locked) == "x");
}

TEST_CASE("atomic file: a write that fails midway leaves the old file whole") {
  // A limit on the size of files stands in for the full disk, which needs no mount and no root.
  TemporaryFolder folder;
  const std::string path = folder.write("a.bin", "old");
  struct rlimit before {};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit tight = before;
  tight.rlim_cur = 4096;
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &tight) == 0);
  std::string message;
  ErrorKind kind = ErrorKind::internal;
  try {
    AtomicFile file(path);
    const std::string much(10000, 'x');
    file.write(much.data(), much.size());
    file.commit();
  } catch (const Error& error) {
    kind = error.kind();
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  CHECK(kind == ErrorKind::output);
  CHECK_THAT(message, Contains(path) && Contains("larger than"));
  CHECK(contents(path) == "old");
  CHECK(folder.entries() == 1);
}
