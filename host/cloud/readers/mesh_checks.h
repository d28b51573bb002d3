#pragma once
/// What Assimp believes of a damaged mesh and must not: found by fuzzing (tests/fuzz/targets/mesh.cpp).
#include <string>

struct aiMesh;

namespace pointgi {

/// Before Assimp reads the file. Throws Error(input) for binary glTF whose chunks are longer than the file, of which it
/// would take the memory, for OFF whose counts and lines do not agree, and for glTF at which Assimp crashes: it follows
/// lines and fans of triangles from faces that it has left out.
void check_mesh_file(const std::string& path);

/// Before Assimp cuts polygons up: that corners exist, and that a mesh of polygons has one of more than three corners;
/// faces without corners count as polygons. Throws Error(input) for the one and mends the other.
void prepare_to_cut(aiMesh& mesh, const std::string& path);

} // namespace pointgi
