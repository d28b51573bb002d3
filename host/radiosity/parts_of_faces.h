#pragma once
/// Which points of a flat face light goes between along it: a wall that stands on a floor, or cuts a room in two, cuts
/// the face in parts that are lit by other things.
#include "octree/vmap/make_links.h"
#include <functional>

namespace pointgi {

/// Which of the segments between `points` are blocked.
using AskSegments = std::function<std::vector<std::uint8_t>(View<Splat> points, View<Segment> segments)>;

/// A number of each point's part: points of one plane that are neighbours are of one part if they see each other from a
/// little above it, and if something hangs close before both or before neither. Of points that are not flat 0; empty
/// where none is flat.
std::vector<std::uint32_t> parts_of_faces(View<Splat> points, const AskSegments& ask);

} // namespace pointgi
