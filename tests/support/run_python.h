#pragma once
/// Python with packages that know nothing of this project.
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <optional>
#include <string>
#include <sys/wait.h>

namespace pointgi::test {

/// What `script`, a file below tests/, prints when python3, or the program that POINTGI_PYTHON names, runs it. None
/// where the script says by exit code 77 that it lacks `packages`: then the test has said so, and is skipped.
inline std::optional<std::string> printed_by_python(const std::string& script, const std::string& arguments,
                                                    const std::string& packages) {
  const TemporaryFolder folder;
  const char* python = std::getenv("POINTGI_PYTHON");
  const std::string command = std::string(python != nullptr ? python : "python3") + " " POINTGI_SOURCE_DIR "/tests/" +
                              script + " " + arguments + " >" + folder.file("out") + " 2>" + folder.file("err");
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 77 || code == 127) {
    WARN("skipped: no " << packages << " for python3");
    something_skipped = true;
    return std::nullopt;
  }
  INFO(contents(folder.file("err")));
  REQUIRE(code == 0);
  return contents(folder.file("out"));
}

} // namespace pointgi::test
