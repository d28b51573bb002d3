// scripts/drivers' table, and scripts/check/device_tests on a test program that passes, fails, crashes and hangs.
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>
#include <sys/wait.h>

namespace test = pointgi::test;
using Catch::Contains;

namespace {

/// What a command prints and its exit code.
std::pair<std::string, int> run(const std::string& command) {
  const test::TemporaryFolder folder;
  const std::string output = folder.file("output.txt");
  const int status = std::system(("cd / && " + command + " > '" + output + "' 2>&1 < /dev/null").c_str());
  return {test::contents(output), WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

const std::string page =
    "# Devices\n\ntext\n<!-- scripts/drivers writes from here -->\n| old |\n<!-- to here -->\n\nmore\n";

/// A test program of five cases, as Catch's answer to their names.
const char* const program =
    "#!/bin/bash\n"
    "case \"$1\" in\n"
    "  --list-test-names-only) printf '%s\\n' 'one, good' 'bad' 'worse [sic]' 'slow' 'elsewhere'; exit 5 ;;\n"
    "  'one\\, good') exit 0 ;;\n"
    "  bad) echo 'what is wrong'; exit 1 ;;\n"
    "  'worse \\[sic]') kill -SEGV $$ ;;\n"
    "  slow) sleep 20 ;;\n"
    "  elsewhere) exit 4 ;;\n"
    "esac\n";

} // namespace

TEST_CASE("the table of drivers is written between its markers, and again in its place", "[drivers_test]") {
  const test::TemporaryFolder folder;
  folder.write("page.md", page);
  folder.write("1-a.row", "| A 1.0 | the reference | 5 of 5 pass |\n");
  folder.write("2-b.row", "| B 2.0 | 2e-8 | 4 of 5 pass, 1 fail |\n");
  const std::string command =
      "'" POINTGI_SOURCE_DIR "/scripts/drivers' --table '" + folder.file("page.md") + "' '" + folder.file("") + "'";
  CHECK(run(command) == std::make_pair(std::string(), 0));
  const std::string written = test::contents(folder.file("page.md"));
  CHECK_THAT(written, Contains("text\n<!-- scripts/drivers writes from here -->\n| driver |"));
  CHECK_THAT(written, Contains("| A 1.0 | the reference | 5 of 5 pass |\n| B 2.0 |"));
  CHECK_THAT(written, Contains("1 fail |\n<!-- to here -->\n\nmore\n"));
  CHECK_THAT(written, !Contains("| old |"));
  folder.write("2-b.row", "| B 2.1 | 0 | 5 of 5 pass |\n");
  CHECK(run(command).second == 0);
  const std::string again = test::contents(folder.file("page.md"));
  CHECK_THAT(again, Contains("| B 2.1 |") && !Contains("| B 2.0 |") && Contains("| A 1.0 |"));
  CHECK(run(command).second == 0);
  CHECK(test::contents(folder.file("page.md")) == again);
}

TEST_CASE("a page without markers is left alone", "[drivers_test]") {
  const test::TemporaryFolder folder;
  folder.write("page.md", "# Devices\n");
  folder.write("1-a.row", "| A |\n");
  const auto [output, code] = run("'" POINTGI_SOURCE_DIR "/scripts/drivers' --table '" + folder.file("page.md") +
                                  "' '" + folder.file("") + "'");
  CHECK(code != 0);
  CHECK_THAT(output, Contains("lacks a line"));
  CHECK(test::contents(folder.file("page.md")) == "# Devices\n");
}

TEST_CASE("an unknown driver is named with those that there are", "[drivers_test]") {
  const auto [output, code] = run("'" POINTGI_SOURCE_DIR "/scripts/drivers' nonesuch");
  CHECK(code == 2);
  CHECK_THAT(output, Contains("nonesuch") && Contains("intel") && Contains("rusticl"));
}

TEST_CASE("device tests are run one by one: a crash or a hang loses one case", "[drivers_test][long]") {
  const test::TemporaryFolder folder;
  folder.write("program", program);
  std::filesystem::permissions(folder.file("program"), std::filesystem::perms::owner_all);
  const auto [output, code] = run("CASE_SECONDS=5 '" POINTGI_SOURCE_DIR "/scripts/check/device_tests' '" +
                                  folder.file("results") + "' '" + folder.file("program") + "'");
  CHECK(code == 1);
  CHECK_THAT(output,
             Contains("1 of 5 device tests pass, 1 fail, 1 crash, 1 take too long, 1 skipped for want of a scan"));
  const std::string table = test::contents(folder.file("results/tests.tsv"));
  CHECK_THAT(table, Contains("passed\t") && Contains("\tone, good\n") && Contains("failed\t") &&
                        Contains("crashed\t") && Contains("timeout\t") && Contains("skipped\t"));
  CHECK_THAT(test::contents(folder.file("results/logs/2.log")), Contains("what is wrong"));
  folder.write(
      "program",
      std::string("#!/bin/bash\n[ \"$1\" != --list-test-names-only ] || { echo 'one, good'; echo bad; exit 2; }\n"
                  "[ \"$1\" = bad ]\n")); // what has passed would fail now
  std::filesystem::permissions(folder.file("program"), std::filesystem::perms::owner_all);
  const auto [resumed, resumed_code] = run("RESUME=yes '" POINTGI_SOURCE_DIR "/scripts/check/device_tests' '" +
                                           folder.file("results") + "' '" + folder.file("program") + "'");
  CHECK(resumed_code == 0);
  CHECK_THAT(resumed, Contains("2 of 2 device tests pass\n"));
}

TEST_CASE("device tests: quick ones go first, and time that is over is said", "[drivers_test][long]") {
  const test::TemporaryFolder folder;
  folder.write("program", program);
  std::filesystem::permissions(folder.file("program"), std::filesystem::perms::owner_all);
  folder.write("order.tsv", "passed\t3\tone, good\npassed\t.1\telsewhere\npassed\t1\tslow\n");
  const auto [output, code] = run("ALL_SECONDS=6 ORDER='" + folder.file("order.tsv") +
                                  "' '" POINTGI_SOURCE_DIR "/scripts/check/device_tests' '" + folder.file("results") +
                                  "' '" + folder.file("program") + "'");
  CHECK(code == 0);
  const std::string table = test::contents(folder.file("results/tests.tsv"));
  CHECK(table.find("elsewhere") < table.find("slow"));
  CHECK(table.find("slow") < table.find("one, good"));
  CHECK_THAT(table, Contains("not run\t0\tone, good"));
  CHECK_THAT(output, Contains("3 not run for want of time"));
}
