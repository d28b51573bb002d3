#pragma once
/// Meshes become point clouds: the renderer knows splats only.
#include "host/cloud/point_cloud.h"
#include <string>
#include <vector>

namespace pointgi {

/// Loads a mesh of any kind that assimp knows (obj, stl, off, gltf ...; PLY is read by read_ply()) and covers it with
/// points, evenly spread: no two on one side of a sheet are closer than 0.78 of the spacing.
/// `spacing`: about the distance of neighbouring points [world units]; 0 chooses it such that about 200,000 result.
/// position, normal (unit; the mesh's own, interpolated, on the side that the winding shows) and area (equal shares,
/// summing to the mesh's area to rounding) are filled; colour is where the mesh has vertex colours or materials;
/// radius and triangle stay empty. Deterministic.
/// `report`: format, triangles (of the mesh), points_in_file (the points made), warnings.
/// Throws Error(input): no such file, nothing that assimp can read, no triangle with an area, `spacing` negative, not
/// finite, or so small that more than 100 million points would result.
PointCloud sample_mesh(const std::string& path, double spacing, CloudReport& report);

/// Whether assimp reads files that are named so.
bool has_mesh_extension(const std::string& path);

/// Files that may be read with the mesh, sorted: all .mtl in the folder of an .obj, all .bin in that of a .gltf. Which
/// of them belong to it only the mesh knows.
std::vector<std::string> files_beside_mesh(const std::string& path);

} // namespace pointgi
