#pragma once
/// Two or three planes in a neighbourhood: the faces that meet at an edge or a corner of a scan.
#include <Eigen/Core>
#include <array>

namespace pointgi {

/// A neighbour, from the point at hand.
struct NearPoint {
  Eigen::Vector3d offset; ///< in spacings
  Eigen::Vector3d normal; ///< unit; beside an edge it may lie between the faces'
};

/// Planes x . normal = height, x from the point at hand, in spacings. The first is the point's own.
struct Faces {
  struct Plane {
    Eigen::Vector3d normal;
    double height;
    bool sticks_out; ///< of the others: the edge between it and the first does
  };
  std::array<Plane, 3> plane;
  unsigned count = 0; ///< 0: the surface is smooth here, or no planes at all
};

/// Neighbours that faces are looked for among: four spacings around.
constexpr unsigned face_neighbours = 64;

/// The faces around a point with this normal. Found where the evidence is clear: at least eight neighbours lie on each
/// plane, nearly all on one of them, the planes are 40° apart or more, and beside the edges points lie on the planes in
/// the mean: where a round surface passes an edge by, they lie below.
/// `normals_given`: they are those of the faces, up to the very edge.
Faces find_faces(const NearPoint* near, unsigned count, const Eigen::Vector3d& normal, bool normals_given);

} // namespace pointgi
