/// Every fault point of a small render (scripts/faults); hours on few cores, and so run by hand.
#include "tests/golden/faults/fault_sweep.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>
#include <set>
#include <sstream>

using namespace pointgi::test;

namespace {

std::string variable(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? "" : text;
}

} // namespace

// POINTGI_FAULTS_KINDS: these only, with blanks between. POINTGI_FAULTS_EVERY: of the faults of a kind every N-th.
TEST_CASE("every fault ends with the right picture or with one clear error", "[.][fault-sweep]") {
  std::vector<std::string> kinds;
  std::istringstream words(variable("POINTGI_FAULTS_KINDS"));
  for (std::string kind; words >> kind;)
    kinds.push_back(kind);
  if (kinds.empty()) kinds = fault_kinds();
  const std::string every_text = variable("POINTGI_FAULTS_EVERY");
  const std::size_t every = every_text.empty() ? 1 : std::max<std::size_t>(1, std::stoul(every_text));
  std::cout << "scene\tkind\tfault points\ttried\tright pictures\tclear errors\tkilled\tnot met\tfindings" << std::endl;
  std::vector<std::string> findings;
  std::set<std::string> tried; // of allocations: the ways pass through many of the same places
  for (const auto& way : {fmm_way(), directions_way(), images_way(), cached_programs_way()}) {
    const FaultScene scene(way);
    for (const std::string& kind : kinds) {
      const std::vector<Fault> all = faults_of(kind, scene.calls());
      std::vector<Fault> some;
      for (std::size_t i = 0; i < all.size(); i += every)
        if (all[i].call != "allocation" || tried.insert(kind + all[i].at).second) some.push_back(all[i]);
      if (some.empty()) continue;
      const FaultTally tally = try_faults(scene, some);
      std::cout << way.name << '\t' << kind << '\t' << all.size() << '\t' << tally.tried << '\t' << tally.right_pictures
                << '\t' << tally.clear_errors << '\t' << tally.killed << '\t' << tally.not_met << '\t'
                << tally.findings.size() << std::endl;
      for (const std::string& finding : tally.findings)
        std::cout << "  " << finding << std::endl;
      findings.insert(findings.end(), tally.findings.begin(), tally.findings.end());
    }
  }
  CHECK(findings.empty());
}
