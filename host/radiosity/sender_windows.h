#pragma once
/// Undersampling of the points that send light: windows of neighbours, of which one sends for all (method.md section
/// 8).
#include "fmm/operators/point_pair.h"
#include "octree/vmap/cluster_tree.h"
#include <array>

namespace pointgi {

/// Points that are close together and face about the same way: members[first, first + count).
struct SenderWindow {
  std::uint32_t first = 0, count = 0;
};

/// Every point of a tree is in one window.
struct SenderWindows {
  std::vector<std::uint32_t> members; ///< indices of the tree's points
  std::vector<SenderWindow> windows;
};

/// A cut through a tree of clusters: nodes none of which holds another, and that hold all points.
using ClusterCut = std::vector<std::uint32_t>;

/// Windows of at most `most` points each, 1 or more: neighbouring clusters as long as they fit into one, runs of `most`
/// points of leaves that hold more, divided by which of the six axes the points face. Deterministic.
SenderWindows sender_windows(const ClusterTree& tree, unsigned most);

/// The clusters of a cut, divided by which of the six axes their points face.
SenderWindows windows_of_cut(const ClusterTree& tree, const ClusterCut& cut);

/// Divides those clusters of a cut in which the radiosity differs most, weighted by their area, until they are `most`,
/// or all are leaves. radiosity: [points x 3], tree order. Deterministic.
ClusterCut refined_cut(const ClusterTree& tree, const ClusterCut& cut, View<double> radiosity, std::size_t most);

/// What sends for each window.
struct Senders {
  std::vector<std::uint32_t> middle; ///< the point of the tree that is nearest to the window's mean place
  std::vector<Splat> seen;          ///< this point, where receivers look whether they see the window, with all its area
  std::vector<ExchangePoint> sends; ///< its place, normal and area, those of all of the window
};

/// The point in the middle of each window, with the area of all.
Senders middle_senders(const ClusterTree& tree, const SenderWindows& windows);
/// The mean place and normal of each window, weighted by area, and its area.
Senders mean_senders(const ClusterTree& tree, const SenderWindows& windows);

/// [windows x 3]: radiosity of what sends for each window, of radiosity [points x 3] in tree order: that of the middle
/// point, or the mean by area.
std::vector<double> middle_radiosity(const Senders& senders, View<double> radiosity);
std::vector<double> mean_radiosity(const ClusterTree& tree, const SenderWindows& windows, View<double> radiosity);

} // namespace pointgi
