/// Where Open Image Denoise is looked for, and what is said of files that are not it.
#include "host/denoise/oidn_library.h"
#include "host/error.h"
#include "tests/support/fake_oidn.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstring>
#include <dlfcn.h>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string works = fake_oidn("works") + "/libOpenImageDenoise.so.2";

/// What load_oidn() says with POINTGI_OIDN as given; empty: it has loaded one.
std::string complaint(const std::string& named) {
  const Variable variable("POINTGI_OIDN", named.c_str());
  try {
    load_oidn();
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::usage);
    CHECK_THAT(error.what(), Catch::StartsWith("--denoise: "));
    CHECK_THAT(error.remedy(), Contains("pip install pyoidn") && Contains("POINTGI_OIDN"));
    return error.what();
  }
  return {};
}

} // namespace

TEST_CASE("POINTGI_OIDN names the library's file, or its folder") {
  CHECK(oidn_candidates(works.c_str()) == std::vector<std::string>{works});
  CHECK(oidn_candidates(fake_oidn("works").c_str()) == std::vector<std::string>{works});
  for (const std::string& named : {works, fake_oidn("works")}) {
    const Variable variable("POINTGI_OIDN", named.c_str());
    CHECK(load_oidn().file == works);
  }
  const std::vector<std::string> usual{"libOpenImageDenoise.so.2", "libOpenImageDenoise.so"};
  CHECK(oidn_candidates(nullptr) == usual);
  CHECK(oidn_candidates("") == usual);
}

TEST_CASE("in a folder the library is found by its usual names first, then by its newest version") {
  const TemporaryFolder folder;
  const auto names = [&] {
    std::vector<std::string> found;
    for (const std::string& file : oidn_candidates(folder.file("").c_str()))
      found.push_back(fs::path(file).filename());
    return found;
  };
  folder.write("libOpenImageDenoise.so.2.1.0", "");
  folder.write("libOpenImageDenoise.so.2.3.1", "");
  folder.write("libOpenImageDenoise.so.1.4.3", "");
  CHECK(names() == std::vector<std::string>{"libOpenImageDenoise.so.2.3.1", "libOpenImageDenoise.so.2.1.0"});
  folder.write("libOpenImageDenoise.so", "");
  folder.write("libOpenImageDenoise.so.2", "");
  CHECK(names() == std::vector<std::string>{"libOpenImageDenoise.so.2", "libOpenImageDenoise.so",
                                            "libOpenImageDenoise.so.2.3.1", "libOpenImageDenoise.so.2.1.0"});
}

TEST_CASE("a file with the full version in its name is loaded from a folder") {
  const TemporaryFolder folder;
  const std::string file = folder.file("libOpenImageDenoise.so.2.3.7");
  fs::copy_file(works, file);
  CHECK(complaint(folder.file("")).empty());
}

TEST_CASE("what POINTGI_OIDN names and is not there is told") {
  const TemporaryFolder folder;
  CHECK_THAT(complaint(folder.file("nowhere")),
             Contains("POINTGI_OIDN names " + folder.file("nowhere") + ", which is not there"));
  folder.write("other.so", "");
  CHECK_THAT(complaint(folder.file("")),
             Contains("POINTGI_OIDN names the folder") && Contains("in which there is no libOpenImageDenoise.so.2"));
}

TEST_CASE("without the library the message says where it was looked for") {
  if (dlopen("libOpenImageDenoise.so.2", RTLD_LAZY) != nullptr ||
      dlopen("libOpenImageDenoise.so", RTLD_LAZY) != nullptr)
    return; // it is installed here
  CHECK_THAT(complaint(""), Contains("Intel Open Image Denoise was not found: POINTGI_OIDN is not set") &&
                                Contains("libOpenImageDenoise.so.2"));
}

TEST_CASE("a damaged library, and what is none, is refused before the loader sees it") {
  const TemporaryFolder folder;
  const std::string whole = contents(works);
  for (const double share : {0.9, 0.5, 0.2, 0.01}) {
    CAPTURE(share);
    // The end of a file may hold only what the loader does not read.
    const std::string cut = whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size())));
    const std::string reason = why_not_loadable(folder.write("cut.so", cut));
    if (share <= 0.2) CHECK_THAT(reason, Contains("ends too early") || Contains("is no library"));
    CHECK_THAT(complaint(folder.file("cut.so")),
               share <= 0.2 ? Contains(folder.file("cut.so") + " is ") : Contains(""));
  }
  CHECK(why_not_loadable(works).empty());
  CHECK_THAT(complaint(folder.write("empty.so", "")), Contains("empty.so is no library"));
  CHECK_THAT(complaint(folder.write("text.so", std::string(5000, 'x'))), Contains("text.so is no library"));
  CHECK_THAT(complaint(POINTGI_BINARY), Contains("lacks functions") || Contains("cannot be loaded"));
  std::string other = whole;
  other[4] = other[4] == 1 ? 2 : 1; // the class: of 32 or 64 bits
  CHECK_THAT(complaint(folder.write("other.so", other)), Contains("another kind of machine"));
  other = whole;
  other[18] = 0x77; // the processor
  CHECK_THAT(complaint(folder.write("processor.so", other)),
             Contains("processor.so is a library for another kind of machine"));
}

TEST_CASE("a library of version 1, and one that lacks functions, are told apart") {
  CHECK_THAT(complaint(fake_oidn("version1")),
             Contains("is of Open Image Denoise 1, which is too old: version 2 is needed"));
  CHECK_THAT(complaint(fake_oidn("lacking")),
             Contains("lacks functions of Open Image Denoise 2: oidnSetFilterBool, oidnExecuteFilter"));
}
