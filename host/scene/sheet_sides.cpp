#include "host/scene/sheet_sides.h"
#include "host/error.h"
#include <algorithm>
#include <limits>

namespace pointgi {

std::size_t divide_sheets(const Scene& scene, std::vector<Splat>& splats, std::vector<std::uint32_t>& id) {
  const auto is_two_sided = [&](const Splat& s) {
    return (scene.materials[material_of(s)].flags & MATERIAL_TWO_SIDED) != 0;
  };
  const auto sheets = static_cast<std::size_t>(std::count_if(splats.begin(), splats.end(), is_two_sided));
  if (sheets == 0) return 0;
  if (scene.materials.size() > SHEET_MATERIALS)
    throw Error(ErrorKind::input, "two_sided: the scene has " + std::to_string(scene.materials.size()) +
                                      " materials, and at most " + std::to_string(SHEET_MATERIALS) +
                                      " go together with sheets; share materials between objects");
  const std::size_t points = splats.size() + sheets;
  if (points > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::memory, "two_sided: both sides of " + std::to_string(sheets) + " splats are " +
                                       std::to_string(points) +
                                       " points, and the octree counts 4294967295 at most; use a coarser spacing, or "
                                       "a smaller cloud");
  splats.resize(points);
  id.resize(points);
  std::size_t to = points;
  for (std::size_t from = points - sheets; from-- > 0;) { // from the end, where there is room
    const Splat splat = splats[from];
    const std::uint32_t own_id = id[from];
    if (is_two_sided(splat)) {
      Splat& back = splats[--to] = splat;
      for (float& n : back.normal)
        n = -n;
      back.material += SHEET_BACK;
      id[to] = own_id;
    }
    splats[--to] = splat;
    if (is_two_sided(splat)) splats[to].material += SHEET_FRONT;
    id[to] = own_id;
  }
  return sheets;
}

} // namespace pointgi
