#pragma once
/// The solution as a point cloud: what `pointgi bake` writes (interface.md).
#include "host/cloud/readers/ply.h"
#include "host/stages/indirect_stages.h"

namespace pointgi {

struct LitCloud {
  PointCloud cloud;               ///< world units; colours are the sRGB of B / pi, brightened by the exposure
  std::vector<PlyColumn> columns; ///< scalar_radiosity_r, _g, _b: B [W/m²]; what else is known of the points
};

/// The points of the pool with their normals and radii, and nothing more. Positions are those of the root cube: within
/// 1e-7 of the scene's size.
LitCloud bare_points(const IndirectRequest& scene);

/// B = E + rho (H_direct + H(B)) of every point of the pool, in its order: all light that leaves the point's front
/// after emission or diffuse reflection, 0 of specular splats.
/// `light` has both irradiances, or where no surface sends any light to another the direct one alone. `exposure`:
/// stops; absent: chosen from the points as from the pixels of a picture (host/image/exposure.h), which the log tells.
LitCloud lit_cloud(const IndirectRequest& scene, const IndirectLight& light, std::optional<double> exposure);

} // namespace pointgi
