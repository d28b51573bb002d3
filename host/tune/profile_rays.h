#pragma once
/// The rays that `pointgi profile` times: the two kinds that a renderer has, and the V-map's.
#include "host/image/picture_writer.h"
#include "octree/splat.h"
#include "octree/view.h"
#include "shared/render_types.h"
#include "shared/traversal_types.h"

namespace pointgi {

/// Coherent: GRID_X x GRID_Y rays a pixel of the window at the middles of their strata, a pixel's together, pixels in
/// squares of a packet and these in tiles, as a renderer takes them; the last ray again up to a whole packet.
std::vector<RayQuery> eye_rays(const Camera& camera, const PixelWindow& window);

/// Incoherent: off splats chosen at random, in cosine-distributed directions about their normals, as light bounces.
std::vector<RayQuery> bounced_rays(View<Splat> splats, std::size_t count, unsigned seed);

/// Between splats chosen at random: indices below `splats`.
std::vector<SegmentQuery> segments_between(std::size_t splats, std::size_t count, unsigned seed);

/// About `pixels` pixels of the picture's middle rows, at most `height`: whole rows where they fit, so that background,
/// rims and surface all count.
PixelWindow middle_window(int width, int height, std::size_t pixels);

} // namespace pointgi
