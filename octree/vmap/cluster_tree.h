#pragma once
/// The octree of radiosity: clusters of points that exchange light, each with what the V-map and the FMM ask of it.
#include "octree/splat.h"
#include "octree/view.h"
#include <cstdint>
#include <vector>

namespace pointgi {

/// A node. Lengths in root cube units. Only children that hold points exist; they stand next to each other.
struct Cluster {
  std::uint32_t first_point = 0; ///< points [first_point, first_point + count) in tree order
  std::uint32_t count = 0;
  std::uint32_t first_child = 0; ///< 0: a leaf (the root is nobody's child)
  std::uint32_t child_count = 0;
  std::uint32_t parent = 0; ///< the root is its own
  std::uint32_t level = 0;
  float low[3], high[3]; ///< tight box around the centres of its points
  float centre[3];       ///< area-weighted mean of the points
  float radius;          ///< of a sphere about `centre` that holds the points
  float axis[3];         ///< unit mean normal, weighted by area
  float cone;            ///< largest angle between `axis` and a point's normal, radians; pi where there is no mean
  float low_along, high_along; ///< bounds of axis.x over the points
  float area;                  ///< sum of the points' effective areas
};

struct ClusterTree {
  std::vector<Cluster> nodes;         ///< nodes[0] is the root; children stand behind their parents
  std::vector<std::uint32_t> order;   ///< order[k]: input index of the k-th point
  std::vector<Splat> points;          ///< in tree order
  std::vector<std::uint32_t> leaf_of; ///< node index of the leaf of each point, in tree order
};

struct ClusterOptions {
  unsigned leaf_capacity = 32;
  unsigned max_depth = 21;
  float planar_cone = 0.6f; ///< a cell of more than a few points whose normals spread wider is divided, radians
};

/// Builds the tree over the splats that take part in diffuse exchange. Backs of sheets have a tree of their own beside
/// the others', below one root. Cells are divided into octants, but where a few flat faces of several points each
/// cross them these do. `part`: of each splat, of points of one plane those of one number are one face
/// (host/radiosity/parts_of_faces.h); empty: all are. Deterministic for any number of threads.
/// Throws std::invalid_argument on options out of range, or on parts of another number of splats.
ClusterTree build_clusters(View<Splat> splats, const ClusterOptions& options, View<std::uint32_t> part = {});

} // namespace pointgi
