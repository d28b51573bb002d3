#pragma once
#include "host/scene/scene.h"

namespace pointgi {

/// Splats on a shape, about `spacing` apart: positions, unit normals, radii that leave no pinhole and do not stick out
/// further than they must, areas whose sum is the shape's area to rounding. No colours.
/// Deterministic. Throws Error(input) when the spacing would give more than `max_points` splats.
PointCloud sample_shape(const ShapeSettings& shape, std::size_t max_points = 100'000'000);

/// Whether its faces are planes: a splat's disc then lies in the shape, wherever it is.
bool has_flat_faces(const ShapeSettings& shape);

} // namespace pointgi
