#include "host/scene/nearest.h"
#include <algorithm>
#include <cctype>

namespace pointgi {
namespace {

constexpr std::size_t longest_word = 64; // nobody mistypes more than that; keeps the quadratic cost bounded
constexpr std::size_t shortest_stem = 3; // one or two letters begin too many words

std::string lower(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

/// Optimal string alignment distance, three rows of the table at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

bool continues(const std::string& longer, const std::string& stem) {
  return stem.size() >= shortest_stem && longer.compare(0, stem.size(), stem) == 0;
}

} // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  if (word.empty() || word.size() > longest_word) return {};
  const std::string wanted = lower(word);
  const std::string* best = nullptr;
  std::size_t best_distance = 0;
  const std::string* continued = nullptr;
  for (const std::string& entry : known) {
    if (entry.empty() || entry.size() > longest_word) continue;
    const std::string candidate = lower(entry);
    if (continued == nullptr && (continues(candidate, wanted) || continues(wanted, candidate))) continued = &entry;
    const std::size_t longer = std::max(wanted.size(), candidate.size());
    const std::size_t shorter = std::min(wanted.size(), candidate.size());
    const std::size_t allowed = std::max<std::size_t>(1, longer / 3);
    // A single letter is one edit away from every other: only its own capital counts.
    if (longer - shorter > allowed || (longer == 1 && wanted != candidate)) continue;
    const std::size_t distance = edit_distance(wanted, candidate);
    if (distance <= allowed && (best == nullptr || distance < best_distance)) {
      best = &entry;
      best_distance = distance;
    }
  }
  if (best != nullptr) return *best;
  return continued != nullptr ? *continued : std::string{};
}

} // namespace pointgi
