#pragma once
/// The segments that stand for a pair of clusters.
#include "octree/vmap/make_links.h"

namespace pointgi {

/// Whether light can go between two points as far as their normals are concerned.
bool face_each_other(const Splat& a, const Splat& b);

/// What `from` sends to `at` at equal radiosity, cos cos A / (d^2 + A / pi), without the constant: a disc seen from its
/// axis, so that the touching do not count for all. 0 where they do not face each other.
float exchange_weight(const Splat& at, const Splat& from);

/// Chooses points of clusters by area.
class PairSamples {
public:
  /// `thesis`: also finds the point nearest to each cluster's centroid. The tree must outlive this.
  PairSamples(const ClusterTree& tree, std::uint32_t seed, bool thesis);

  /// Appends those of `count` segments between a and b whose ends face each other; returns how many. Hammersley's
  /// points along both curves, turned by two random numbers of (seed, a, b, salt).
  std::uint32_t stratified(std::uint32_t a, std::uint32_t b, std::uint32_t count, std::uint32_t salt,
                           std::vector<Segment>& out) const;

  /// Appends at most `count` of all segments between a and b whose ends face each other, evenly; returns how many.
  /// Goes through all pairs of points.
  std::uint32_t exhaustive(std::uint32_t a, std::uint32_t b, std::uint32_t count, std::vector<Segment>& out) const;

  /// Appends `count` segments from a point to points of cluster b, drawn in proportion to what each sends it at equal
  /// radiosity, stratified, the same one more than once where it sends most; 0 where none of those looked at faces it.
  /// Of a cluster of many points not all are looked at. `salt` and the point turn the strata.
  std::uint32_t towards(std::uint32_t point, std::uint32_t b, std::uint32_t count, std::uint32_t salt,
                        std::vector<Segment>& out) const;

  /// Appends the segment between the points nearest to the centroids, whether they face each other or not; 1.
  std::uint32_t central(std::uint32_t a, std::uint32_t b, std::vector<Segment>& out) const;

private:
  std::uint32_t point_at(const Cluster& c, double share) const;

  const ClusterTree& tree_;
  std::uint32_t seed_;
  std::vector<double> area_before_;    ///< of all points before each, and of all
  std::vector<std::uint32_t> central_; ///< thesis only: a point a node
};

} // namespace pointgi
