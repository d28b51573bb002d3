// Output that cannot be written, and files that are no pictures (truths.md §3).
#include "host/error.h"
#include "host/image/picture_writer.h"
#include "host/image/png_writer.h"
#include "tests/support/promises.h"
#include "tests/unit/host/image/picture_fixture.h"
#include <catch2/catch.hpp>
#include <csignal>
#include <optional>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace pointgi;
using namespace pointgi::test::picture;

namespace {

/// What the writer says about this path from construction to finish(); nothing when it is content.
std::optional<Error> error_of_writing(const std::string& path, int height = 400) {
  try {
    PictureWriter writer(path, 300, height, {0, 300, 0, height}, rgb_channels(), {}, 0.0);
    for (int row = 0; row < height; row += 40)
      writer.write(random_band(rgb_channels(), row, 40, 300, 1));
    writer.finish(0.0);
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

void check_output_error(const std::optional<Error>& error, const std::string& where, const std::string& what) {
  REQUIRE(error);
  CHECK(error->kind() == ErrorKind::output);
  CHECK_THAT(error->what(), Catch::Contains(where));
  CHECK_THAT(error->what(), Catch::Contains(what));
  CHECK_THAT(error->what(), Catch::Contains("; ")); // a remedy follows
}

/// A file larger than `bytes` gives EFBIG, as a full disk gives ENOSPC, and needs no root.
class FileSizeLimit {
public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
  rlimit before_{};
  void (*handler_)(int);
};

} // namespace

TEST_CASE("a writer that is not finished leaves the old files whole and nothing else", "[picture]") {
  const Folder folder;
  put_bytes(folder.file("a.exr"), "old exr");
  put_bytes(folder.file("a.png"), "old png");
  {
    PictureWriter writer(folder.file("a.exr"), 30, 40, {0, 30, 0, 40}, rgb_channels(), {}, 0.0);
    writer.write(random_band(rgb_channels(), 0, 40, 30, 1));
    CHECK(bytes_of(folder.file("a.exr")) == "old exr");
  }
  CHECK(bytes_of(folder.file("a.exr")) == "old exr");
  CHECK(bytes_of(folder.file("a.png")) == "old png");
  CHECK(folder.names() == std::vector<std::string>{"a.exr", "a.png"});

  CHECK_FALSE(error_of_writing(folder.file("a.exr")));
  CHECK(read_exr(folder.file("a.exr")).width == 300);
  CHECK(folder.names() == std::vector<std::string>{"a.exr", "a.png"});
}

TEST_CASE("paths that cannot be written are refused before any row", "[picture]") {
  const Folder folder;
  put_bytes(folder.file("plain"), "");
  std::filesystem::create_directory(folder.file("folder.exr"));
  std::filesystem::create_directory(folder.file("b.png"));
  const auto before = folder.names();
  check_output_error(error_of_writing(folder.file("missing/a.exr")), "missing/a.exr", "create the folder");
  check_output_error(error_of_writing(folder.file("plain/a.exr")), "plain/a.exr", "create the folder");
  check_output_error(error_of_writing(folder.file("folder.exr")), "folder.exr", "name of a file");
  check_output_error(error_of_writing(folder.file("b.exr")), "b.png", "name of a file"); // its PNG cannot be written
  for (const char* name : {"a", "a.png", "a.exr.gz", ".exr", "exr", "", "folder/"})
    check_output_error(error_of_writing(*name == '\0' ? "" : folder.file(name)), name, "must end in .exr");
  check_output_error(error_of_writing("/dev/full"), "/dev/full", "must end in .exr");
  CHECK(folder.names() == before);

  CHECK_FALSE(error_of_writing(folder.file("UPPER.EXR")));
  CHECK(std::filesystem::exists(folder.file("UPPER.png")));
}

TEST_CASE("a folder without write permission is refused", "[picture]") {
  if (::geteuid() == 0) {
    WARN("skipped: root may write everywhere");
    return;
  }
  const Folder folder;
  ::chmod(folder.path().c_str(), 0555);
  check_output_error(error_of_writing(folder.file("a.exr")), "a.exr", "may write");
  ::chmod(folder.path().c_str(), 0755);
}

TEST_CASE("a file that cannot grow is an error and the old one stays", "[picture]") {
  const Folder folder;
  put_bytes(folder.file("a.exr"), "old");
  // 300 x 400 x 3 random floats make 1.4 MB of EXR: the limits strike in its header, in its line table, and early and
  // late in its rows.
  for (const rlim_t limit : {0, 100, 600, 10'000, 200'000, 1'300'000}) {
    INFO("limit " << limit);
    std::optional<Error> error;
    {
      const FileSizeLimit limited(limit);
      error = error_of_writing(folder.file("a.exr"));
    }
    check_output_error(error, "a.", "cannot write");
    CHECK(bytes_of(folder.file("a.exr")) == "old");
    CHECK(folder.names() == std::vector<std::string>{"a.exr"});
  }
}

TEST_CASE("a PNG that cannot grow is an error too", "[picture]") {
  const Folder folder;
  std::mt19937 random(1);
  std::vector<std::uint8_t> row(3 * 300);
  std::optional<Error> error;
  try {
    const FileSizeLimit limited(10'000); // of the 360 kB that 400 rows of random bytes need
    PngWriter png(folder.file("a.png"), 300, 400);
    for (int y = 0; y < 400; ++y) {
      for (std::uint8_t& byte : row)
        byte = static_cast<std::uint8_t>(random() & 0xffu);
      png.write_row(row.data());
    }
    png.close();
    png.commit();
  } catch (const Error& caught) {
    error = caught;
  }
  check_output_error(error, "a.png", "cannot write");
  CHECK(folder.names().empty());
}

TEST_CASE("a full disk is an error, the old file stays and no temporary is left", "[picture]") {
  const Folder folder;
  const std::string disk = folder.file("disk");
  std::filesystem::create_directory(disk);
  if (::mount("pointgi-test", disk.c_str(), "tmpfs", 0, "size=1m") != 0) {
    WARN("skipped: a small disk can be mounted by root only");
    return;
  }
  CHECK_FALSE(error_of_writing(disk + "/a.exr", 40)); // 0.2 MB fits
  const std::string old = bytes_of(disk + "/a.exr");
  check_output_error(error_of_writing(disk + "/a.exr"), "disk/a.", "No space left");
  CHECK(bytes_of(disk + "/a.exr") == old);
  const auto entries = std::distance(std::filesystem::directory_iterator(disk), std::filesystem::directory_iterator());
  CHECK(entries == 2);
  CHECK(::umount(disk.c_str()) == 0);
}

TEST_CASE("what is no EXR picture is refused as input", "[picture]") {
  const Folder folder;
  REQUIRE_FALSE(error_of_writing(folder.file("good.exr"), 40));
  const std::string good = bytes_of(folder.file("good.exr"));
  auto check_refused = [&](const std::string& path) {
    INFO(path);
    try {
      read_exr(path);
      FAIL("accepted");
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::input);
      CHECK_THAT(error.what(), Catch::Contains(path));
    }
  };
  check_refused(folder.file("missing.exr"));
  check_refused(folder.path().string());
  check_refused("/dev/zero");
  REQUIRE(::mkfifo(folder.file("pipe.exr").c_str(), 0600) == 0);
  check_refused(folder.file("pipe.exr"));
  check_refused(folder.file("good.png"));
  CHECK_THROWS_WITH(read_exr(folder.file("good.png")), Catch::Contains("a PNG, which holds no radiances"));
  const std::string damaged = folder.file("damaged.exr");
  for (const std::size_t kept : {std::size_t{0}, std::size_t{4}, std::size_t{9}, std::size_t{200}, good.size() / 2}) {
    put_bytes(damaged, good.substr(0, kept));
    check_refused(damaged);
  }
  // A data window of 2^30 x 2^30 pixels must not be allocated.
  std::string huge = good;
  const std::size_t window = huge.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
  const std::string extent("\xff\xff\xff\x3f\xff\xff\xff\x3f", 8);
  huge.replace(window + 8, 8, extent);
  put_bytes(damaged, huge);
  check_refused(damaged);
}

TEST_CASE("an error over an EXR picture shows the name of a channel in printable characters", "[picture]") {
  const Folder folder;
  REQUIRE_FALSE(error_of_writing(folder.file("good.exr"), 40));
  std::string bytes = bytes_of(folder.file("good.exr"));
  // The first channel: its name, type, how it is kept, and samples in x.
  const std::size_t name = bytes.find(std::string("channels\0chlist\0", 16)) + 16 + 4;
  bytes[name] = '\x1b';
  // 300 pixels are a multiple of 2 and none of 7, which OpenEXR refuses itself.
  for (const char samples : {'\2', '\7'}) {
    bytes[name + 2 + 4 + 4] = samples;
    put_bytes(folder.file("damaged.exr"), bytes);
    try {
      read_exr(folder.file("damaged.exr"));
      FAIL("accepted");
    } catch (const Error& error) {
      CHECK(test::broken_promise(error, folder.file("damaged.exr")) == "");
      CHECK_THAT(error.what(), Catch::Contains("\\x1b"));
    }
  }
}
