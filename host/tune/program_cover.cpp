#include "host/tune/program_cover.h"
#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>

namespace pointgi {

namespace {

/// The options but for "-D" itself, and whether it is for GPUs.
std::set<std::string> options_of(const ProgramUse& use) {
  std::istringstream text(use.program.options);
  std::set<std::string> options{std::istream_iterator<std::string>(text), {}};
  options.erase("-D");
  if (use.gpu) options.insert("(gpu)");
  return options;
}

/// Numbers of the pairs that a program has: each of two options, there or not.
std::vector<std::size_t> pairs_of(const std::set<std::string>& has, const std::vector<std::string>& options) {
  std::vector<std::size_t> pairs;
  const std::size_t states = 2 * options.size();
  const auto state = [&](std::size_t i) { return 2 * i + has.count(options[i]); };
  for (std::size_t i = 0; i < options.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) // an option with itself: files of one option have pairs too
      pairs.push_back(state(i) * states + state(j));
  return pairs;
}

/// Places in `programs` of one kernel file's cover.
std::vector<std::size_t> cover_of_file(const std::vector<ProgramUse>& programs,
                                       const std::vector<std::size_t>& of_file) {
  std::vector<std::set<std::string>> has;
  std::set<std::string> options{""}; // an option that none has: a file without options has a pair too
  for (const std::size_t at : of_file) {
    has.push_back(options_of(programs[at]));
    options.insert(has.back().begin(), has.back().end());
  }
  const std::vector<std::string> every(options.begin(), options.end());
  std::vector<std::vector<std::size_t>> pairs;
  std::set<std::size_t> missing;
  for (const auto& of_program : has) {
    pairs.push_back(pairs_of(of_program, every));
    missing.insert(pairs.back().begin(), pairs.back().end());
  }
  std::vector<std::size_t> chosen;
  while (!missing.empty()) {
    std::size_t best = 0, most = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto is_missing = [&](std::size_t pair) { return missing.count(pair) != 0; };
      const auto gain = static_cast<std::size_t>(std::count_if(pairs[i].begin(), pairs[i].end(), is_missing));
      if (gain > most) best = i, most = gain;
    }
    for (const std::size_t pair : pairs[best])
      missing.erase(pair);
    chosen.push_back(of_file[best]);
  }
  return chosen;
}

} // namespace

std::vector<ProgramUse> cover_of_pairs(const std::vector<ProgramUse>& programs) {
  std::map<std::string, std::vector<std::size_t>> files;
  for (std::size_t i = 0; i < programs.size(); ++i)
    files[programs[i].program.file].push_back(i);
  std::set<std::size_t> chosen;
  for (const auto& [file, places] : files) {
    const auto of_file = cover_of_file(programs, places);
    chosen.insert(of_file.begin(), of_file.end());
  }
  std::vector<ProgramUse> cover;
  for (const std::size_t at : chosen)
    cover.push_back(programs[at]);
  return cover;
}

} // namespace pointgi
