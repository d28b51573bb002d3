#pragma once
/// The solution for those who gave a scan: their own file, with what was found for each of its points.
#include "host/stages/lit_cloud.h"
#include "host/stages/prepared_scene.h"

namespace pointgi {

/// Writes PLY. A scene without a file_order: the points of `lit` in world coordinates. Else the scene's one cloud
/// again, in its order and with all that it has, and behind that for each point
///   lit                    1; 0 where the point was left out or dropped, or its material reflects nothing diffusely:
///                          all that follows is then 0
///   red green blue         the colours of `lit`, of what is two-sided the mean of both sides; where `lit` has none,
///                          those of the file stay. Else the file's own are called albedo_red, …
///   nx ny nz, radius       of the splats, in the file's coordinates, where the file has none
///   the columns of `lit`   and, with _back behind their names, those of the backs where something is two-sided.
/// A PLY file stays as it is but for these (host/cloud/readers/ply_columns.h); of other formats all fields become
/// properties. `scene`, `ready`: what `lit` was made of. Throws Error(input) where the file cannot be read any more,
/// Error(output).
void write_lit_ply(const std::string& output, const Scene& scene, const PreparedScene& ready, const LitCloud& lit);

/// Whether write_lit_las() can: the scene is one cloud and nothing else, in a file called .las or .laz.
bool can_write_las(const Scene& scene);

/// Writes LAS: the scene's one cloud, a LAS file, again, with lit and the columns of `lit` as extra bytes (radiosity_r,
/// …, without scalar_); red, green and blue become the colours of `lit` where the file has colours, its own are kept as
/// extra bytes albedo_red, … Else as write_lit_ply().
void write_lit_las(const std::string& output, const Scene& scene, const PreparedScene& ready, const LitCloud& lit);

} // namespace pointgi
