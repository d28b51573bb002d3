#include "host/scene/sheet_sides.h"
#include "host/error.h"
#include "octree/parallel.h"
#include <algorithm>
#include <limits>
#include <unordered_map>

namespace pointgi {

namespace {

bool has_no_side(Structure structure) {
  return structure == Structure::line || structure == Structure::volume || structure == Structure::sheet;
}

bool may_be_sheet(const MaterialSettings& material) {
  return exchanges_light(material) && !material.one_sided && material.emission.isZero();
}

/// The front and, behind it, the back of a sheet.
void append_sheet(const Splat& front, const Splat& back, std::vector<Splat>& splats) {
  splats.push_back(front);
  splats.back().material += SHEET_FRONT;
  splats.push_back(back);
  splats.back().material += SHEET_BACK;
  for (int k = 0; k < 3; ++k)
    splats.back().normal[k] = -front.normal[k];
}

} // namespace

std::size_t divide_sheets(const Scene& scene, std::vector<Splat>& splats, std::vector<std::uint32_t>& id,
                          const std::vector<Structure>& structure, const std::vector<CoincidentSides>& sides) {
  const auto is_two_sided = [&](std::size_t i) {
    const MaterialSettings& material = scene.materials[material_of(splats[i])];
    if ((material.flags & MATERIAL_TWO_SIDED) != 0) return true;
    return !structure.empty() && has_no_side(structure[id[i]]) && may_be_sheet(material);
  };
  const std::size_t divided =
      parallel_sum(splats.size(), 1 << 16, std::size_t{0}, [&](std::size_t& count, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          count += is_two_sided(i) ? 1u : 0u;
      });
  if (divided == 0 && sides.empty()) return 0;
  std::vector<bool> two_sided(splats.size());
  for (std::size_t i = 0; i < splats.size(); ++i)
    two_sided[i] = is_two_sided(i);
  std::unordered_map<std::uint32_t, std::uint32_t> other_side;
  std::vector<bool> is_back(sides.empty() ? 0 : splats.size());
  for (const CoincidentSides& pair : sides) {
    if (two_sided[pair.one] || two_sided[pair.other]) continue;
    if (!may_be_sheet(scene.materials[material_of(splats[pair.one])])) continue;
    other_side[pair.one] = pair.other;
    is_back[pair.other] = true;
  }
  if (divided + other_side.size() == 0) return 0;
  const std::size_t points = splats.size() + divided;
  if (points > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::memory, "two_sided: both sides of " + std::to_string(divided) + " splats are " +
                                       std::to_string(points) +
                                       " points, and the octree counts 4294967295 at most; use a coarser spacing, or "
                                       "a smaller cloud");
  std::vector<Splat> all;
  std::vector<std::uint32_t> all_id;
  all.reserve(points);
  all_id.reserve(points);
  for (std::uint32_t i = 0; i < splats.size(); ++i) {
    if (!is_back.empty() && is_back[i]) continue;
    const auto other = other_side.find(i);
    if (!two_sided[i] && other == other_side.end()) {
      all.push_back(splats[i]);
      all_id.push_back(id[i]);
      continue;
    }
    Splat back = splats[i];
    if (other != other_side.end()) {
      back = splats[other->second];
      back.radius = splats[i].radius = std::max(back.radius, splats[i].radius); // one disc
    }
    append_sheet(splats[i], back, all);
    all_id.push_back(id[i]);
    all_id.push_back(other == other_side.end() ? id[i] : id[other->second]);
  }
  splats = std::move(all);
  id = std::move(all_id);
  return divided + other_side.size();
}

} // namespace pointgi
