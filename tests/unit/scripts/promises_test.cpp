// scripts/check/promises on pages of its own: it must pass a good one, and find each fault by its line.
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <sys/wait.h>

namespace test = pointgi::test;
using Catch::Contains;

namespace {

constexpr const char* head = "# Promises\n\n| promise | tests | date |\n|---|---|---|\n";
const std::string good =
    "| It is checked | `tests/unit/scripts/promises_test.cpp` \"a promise with its tests and date is "
    "kept\"; `tests/unit/scripts/promises_test.cpp` \"a page without promises is not called good\" | "
    "2026-11-30 |\n";

struct Checked {
  int code;
  std::string said;
};

Checked check(const std::string& rows) {
  const test::TemporaryFolder folder;
  const std::string page = folder.write("promises.md", rows), said = folder.file("said");
  const int status =
      std::system((POINTGI_SOURCE_DIR "/scripts/check/promises " + page + " >" + said + " 2>&1").c_str());
  return {WEXITSTATUS(status), test::contents(said)};
}

} // namespace

TEST_CASE("a promise with its tests and date is kept") {
  const Checked checked = check(head + good);
  CHECK(checked.code == 0);
  CHECK_THAT(checked.said, Contains("all 1 name their tests"));
}

TEST_CASE("a promise without a test, with one that is not there, or without a date is named with its line") {
  const Checked checked =
      check(head + good + "| Nothing holds it | believe it | 2026-11-30 |\n" +
            "| A lost test | `tests/unit/scripts/promises_test.cpp` \"no such case\" | 2026-11-30 |\n" +
            "| A lost file | `tests/unit/none_test.cpp` \"case\" | 2026-11-30 |\n" + good.substr(0, good.size() - 14) +
            "soon |\n");
  CHECK(checked.code == 1);
  CHECK_THAT(checked.said, Contains(":6: no test: Nothing holds it") && Contains(":7: ") &&
                               Contains("has no test \"no such case\": A lost test") &&
                               Contains(":8: tests/unit/none_test.cpp is not there: A lost file") &&
                               Contains(":9: expected a date, found \"soon\"") && !Contains(":5:"));
}

TEST_CASE("a page without promises is not called good") {
  CHECK(check("# Promises\n").code == 2);
}
