#include "host/tune/program_cover.h"
#include <catch2/catch.hpp>
#include <set>
#include <string>

using namespace pointgi;

namespace {

using Names = std::set<std::string>;

ProgramUse use(const std::string& file, const std::string& options, bool gpu = true) {
  return {{file, options}, true, gpu};
}

Names names_of(const std::vector<ProgramUse>& uses) {
  Names names;
  for (const ProgramUse& use : uses)
    names.insert(use.program.file + ":" + use.program.options);
  return names;
}

} // namespace

TEST_CASE("a cover of pairs keeps each file, each option and each two that meet, and leaves out what is told twice") {
  CHECK(cover_of_pairs({}).empty());
  CHECK(names_of(cover_of_pairs({use("plain.cl", "")})) == Names{"plain.cl:"});
  // Of three options that are there or not, four programs of eight show every two in all four states.
  std::vector<ProgramUse> all;
  for (int bits = 0; bits < 8; ++bits)
    all.push_back(
        use("a.cl", std::string(bits & 1 ? "-D A " : "") + (bits & 2 ? "-D B " : "") + (bits & 4 ? "-D C" : "")));
  const auto cover = cover_of_pairs(all);
  CHECK(cover.size() < all.size());
  const Names names = names_of(cover);
  const char* letters = "ABC";
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j)
      for (int state = 0; state < 4; ++state) {
        bool shown = false;
        for (const std::string& name : names)
          shown |= (name.find(std::string("-D ") + letters[i]) != std::string::npos) == ((state & 1) != 0) &&
                   (name.find(std::string("-D ") + letters[j]) != std::string::npos) == ((state & 2) != 0);
        CAPTURE(i, j, state);
        CHECK(shown);
      }
  // What a GPU is offered is not left out for what it is not.
  const auto classes = cover_of_pairs({use("a.cl", "-D A", false), use("a.cl", "-D A -D B", true)});
  CHECK(classes.size() == 2);
}

TEST_CASE("the cover of all programs is a quarter of them, and has every kernel file and every option") {
  const auto all = all_programs(), cover = cover_of_pairs(all);
  CHECK(cover.size() * 4 < all.size());
  const auto words = [](const std::vector<ProgramUse>& uses) {
    Names found;
    for (const ProgramUse& use : uses) {
      std::string text = use.program.options + " ";
      for (std::size_t at = 0, end; (end = text.find(' ', at)) != std::string::npos; at = end + 1)
        found.insert(use.program.file + ":" + text.substr(at, end - at));
    }
    return found;
  };
  CHECK(words(cover) == words(all));
}
