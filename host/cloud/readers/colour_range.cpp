#include "host/cloud/readers/colour_range.h"
#include "octree/parallel.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

namespace pointgi {

namespace {

constexpr std::size_t grain = 1 << 16;
constexpr double few = 1e-3; // of the points: they don't tell what the others' numbers mean

enum class Numbers { bytes, integers, floats };

Numbers numbers_of(const std::array<FieldType, 3>& types) {
  Numbers numbers = Numbers::bytes;
  for (const FieldType type : types) {
    if (is_float(type)) return Numbers::floats;
    if (size_of(type) > 1) numbers = Numbers::integers;
  }
  return numbers;
}

/// Points with a channel above `limit`.
std::size_t count_above(const std::vector<Eigen::Vector3f>& colours, float limit) {
  std::atomic<std::size_t> count{0};
  parallel_ranges(colours.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = begin; i < end; ++i)
      here += (colours[i].array() > limit).any() ? 1u : 0u; // NaN is above nothing
    count += here;
  });
  return count;
}

/// A range that colours may have, and what points must not exceed, but for a few, to have it.
struct Range {
  float white;
  float limit;
};

/// The smallest of the ranges that holds nearly all points; the last where none does.
Range choose_range(const std::vector<Eigen::Vector3f>& colours, Numbers numbers) {
  if (numbers == Numbers::bytes) return {255.0f, 255.0f};
  // Twice white is still 0..1: of 0..255 it would be black for nearly all points.
  for (const Range range : {Range{1.0f, 2.0f}, Range{255.0f, 255.0f}}) {
    if (numbers == Numbers::integers && range.white == 1.0f) continue;
    const auto above = static_cast<double>(count_above(colours, range.limit));
    if (above <= few * static_cast<double>(colours.size())) return range;
  }
  return {65535.0f, 65535.0f};
}

std::string text_of(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", static_cast<double>(value));
  return text;
}

} // namespace

void scale_colours(const std::array<FieldType, 3>& types, std::vector<Eigen::Vector3f>& colours, CloudReport& report) {
  const Numbers numbers = numbers_of(types);
  const Range range = choose_range(colours, numbers);
  const bool is_short = std::find(types.begin(), types.end(), FieldType::u16) != types.end();
  if (numbers == Numbers::floats && range.white > 1.0f)
    report.notes.push_back("the colours are floats above 1: they were taken as 0 to " + text_of(range.white));
  if (numbers == Numbers::integers && is_short && range.white == 255.0f)
    report.notes.push_back("the colours are 16-bit integers but nearly none is above 255: they were taken as 0 to 255");
  // A thousandth of grace: a conversion elsewhere may have rounded white up.
  const std::size_t brighter = numbers == Numbers::bytes ? 0 : count_above(colours, 1.001f * range.white);
  if (brighter > 0)
    report.warnings.push_back("the colours of " + std::to_string(brighter) + " of " + std::to_string(colours.size()) +
                              " points are above " + text_of(range.white) +
                              ", which is white to the others: they were taken as white there. Correct the file's "
                              "colours if they are meant otherwise.");
  const float scale = 1.0f / range.white;
  parallel_ranges(colours.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int k = 0; k < 3; ++k)
        if (std::isfinite(colours[i][k])) colours[i][k] = std::clamp(colours[i][k] * scale, 0.0f, 1.0f);
  });
}

} // namespace pointgi
