#include "host/cloud/input_file.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("input file: text for messages is safe for a terminal") {
  CHECK(quoted_bytes("vertex 7") == "\"vertex 7\"");
  CHECK(quoted_bytes(std::string_view("a\0\n\x1b[31m", 8)) == "\"a\\x00\\x0a\\x1b[31m\"");
  CHECK(quoted_bytes("\xc3\xa4 \"\\") == "\"\\xc3\\xa4 \\x22\\x5c\"");
  CHECK(printable("abcdef", 3) == "abc...");
  CHECK(printable("abc", 3) == "abc");
}

TEST_CASE("input file: all bytes are read and an empty file is empty") {
  const test::TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  const FileBytes read = read_whole_file(folder.write("a.bin", bytes));
  CHECK(std::string(read.data.get(), read.size) == bytes);
  CHECK(read_whole_file(folder.write("empty", "")).size == 0);
}

TEST_CASE("input file: any piece of a file can be read and one that is gone is an error") {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("a.bin", "0123456789");
  const InputFile file(path);
  CHECK(file.size() == 10);
  std::string piece(4, ' ');
  file.read(3, piece.data(), 4);
  CHECK(piece == "3456");
  std::filesystem::resize_file(path, 5);
  CHECK_THROWS_WITH(file.read(3, piece.data(), 4), Catch::Matchers::Contains("became shorter while it was read"));
  CHECK_THROWS_WITH(InputFile(folder.file("absent")), Catch::Matchers::Contains("No such file"));
}
