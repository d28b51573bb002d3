#include "host/radiosity/sender_windows.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

struct Range {
  std::uint32_t first = 0, count = 0; ///< of the tree's points
};

/// Ranges of at most `most` points, clusters that follow each other as long as they fit into one.
void add_ranges(const ClusterTree& tree, std::uint32_t node, std::uint32_t most, std::vector<Range>& ranges) {
  const Cluster& c = tree.nodes[node];
  if (c.count <= most) {
    // Only within one parent: cells further off than siblings need not be neighbours.
    const bool sibling = !ranges.empty() && node != 0 && ranges.back().first >= tree.nodes[c.parent].first_point &&
                         ranges.back().first + ranges.back().count == c.first_point;
    if (sibling && ranges.back().count + c.count <= most)
      ranges.back().count += c.count;
    else
      ranges.push_back({c.first_point, c.count});
    return;
  }
  for (std::uint32_t k = 0; k < c.child_count; ++k)
    add_ranges(tree, c.first_child + k, most, ranges);
  if (c.child_count == 0)
    for (std::uint32_t first = 0; first < c.count; first += most)
      ranges.push_back({c.first_point + first, std::min(most, c.count - first)});
}

/// Which of +x, -x, +y, ... a splat faces most.
std::uint32_t axis_faced(const Splat& s) {
  std::uint32_t axis = 0;
  for (std::uint32_t a = 1; a < 3; ++a)
    if (std::fabs(s.normal[a]) > std::fabs(s.normal[axis])) axis = a;
  return 2 * axis + (s.normal[axis] < 0.0f ? 1 : 0);
}

SenderWindows divided_by_facing(const ClusterTree& tree, const std::vector<Range>& ranges) {
  SenderWindows result;
  result.members.reserve(tree.points.size());
  for (const Range& range : ranges) {
    std::array<std::vector<std::uint32_t>, 6> facing;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
      facing[axis_faced(tree.points[i])].push_back(i);
    for (const std::vector<std::uint32_t>& points : facing) {
      if (points.empty()) continue;
      result.windows.push_back(
          {static_cast<std::uint32_t>(result.members.size()), static_cast<std::uint32_t>(points.size())});
      result.members.insert(result.members.end(), points.begin(), points.end());
    }
  }
  return result;
}

/// Area times how far the radiosity of a cluster's parts is from its own, the worst colour's.
double spread(const ClusterTree& tree, std::uint32_t node, const std::vector<std::array<double, 3>>& mean) {
  const Cluster& c = tree.nodes[node];
  double sum = 0.0;
  for (std::uint32_t k = c.first_child; k < c.first_child + c.child_count; ++k) {
    double worst = 0.0;
    for (std::size_t colour = 0; colour < 3; ++colour)
      worst = std::max(worst, std::fabs(mean[k][colour] - mean[node][colour]));
    sum += worst * double{tree.nodes[k].area};
  }
  return sum;
}

} // namespace

SenderWindows sender_windows(const ClusterTree& tree, unsigned most) {
  std::vector<Range> ranges;
  if (!tree.points.empty()) add_ranges(tree, 0, std::max(1u, most), ranges);
  return divided_by_facing(tree, ranges);
}

SenderWindows windows_of_cut(const ClusterTree& tree, const ClusterCut& cut) {
  std::vector<Range> ranges;
  for (const std::uint32_t node : cut)
    ranges.push_back({tree.nodes[node].first_point, tree.nodes[node].count});
  return divided_by_facing(tree, ranges);
}

ClusterCut refined_cut(const ClusterTree& tree, const ClusterCut& cut, View<double> radiosity, std::size_t most) {
  std::vector<std::array<double, 3>> mean(tree.nodes.size());
  for (std::size_t node = 0; node < tree.nodes.size(); ++node) {
    const Cluster& c = tree.nodes[node];
    double area = 0.0;
    for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i) {
      area += double{tree.points[i].area};
      for (std::size_t colour = 0; colour < 3; ++colour)
        mean[node][colour] += radiosity[3 * i + colour] * double{tree.points[i].area};
    }
    for (double& value : mean[node])
      value = area > 0.0 ? value / area : 0.0;
  }
  struct Node {
    double spread;
    std::uint32_t node;
    bool operator<(const Node& other) const {
      return spread < other.spread || (spread == other.spread && node > other.node);
    }
  };
  std::vector<Node> heap;
  ClusterCut done;
  for (const std::uint32_t node : cut)
    if (tree.nodes[node].child_count > 0)
      heap.push_back({spread(tree, node, mean), node});
    else
      done.push_back(node);
  std::make_heap(heap.begin(), heap.end());
  while (!heap.empty() && heap.size() + done.size() < most) {
    std::pop_heap(heap.begin(), heap.end());
    const Cluster& c = tree.nodes[heap.back().node];
    heap.pop_back();
    for (std::uint32_t k = c.first_child; k < c.first_child + c.child_count; ++k)
      if (tree.nodes[k].child_count == 0)
        done.push_back(k);
      else {
        heap.push_back({spread(tree, k, mean), k});
        std::push_heap(heap.begin(), heap.end());
      }
  }
  for (const Node& node : heap)
    done.push_back(node.node);
  std::sort(done.begin(), done.end());
  return done;
}

Senders mean_senders(const ClusterTree& tree, const SenderWindows& windows) {
  Senders senders;
  for (const SenderWindow& w : windows.windows) {
    ExchangePoint mean;
    mean.n.setZero();
    for (std::uint32_t k = w.first; k < w.first + w.count; ++k) {
      const ExchangePoint p(tree.points[windows.members[k]]);
      mean.area += p.area;
      mean.x += p.area * p.x;
      mean.n += p.area * p.n;
    }
    if (mean.area > 0.0)
      mean.x /= mean.area;
    else
      mean = ExchangePoint(tree.points[windows.members[w.first]]); // sends nothing
    mean.n.normalize(); // all face one axis more than any other: the sum is not 0
    const auto distance = [&](std::uint32_t k) {
      return (ExchangePoint(tree.points[windows.members[k]]).x - mean.x).squaredNorm();
    };
    std::uint32_t nearest = w.first;
    for (std::uint32_t k = w.first; k < w.first + w.count; ++k)
      if (distance(k) < distance(nearest)) nearest = k;
    senders.middle.push_back(windows.members[nearest]);
    senders.seen.push_back(tree.points[windows.members[nearest]]);
    senders.seen.back().area = static_cast<float>(mean.area);
    senders.sends.push_back(mean);
  }
  return senders;
}

Senders middle_senders(const ClusterTree& tree, const SenderWindows& windows) {
  Senders senders = mean_senders(tree, windows);
  for (std::size_t w = 0; w < senders.seen.size(); ++w) {
    const double area = senders.sends[w].area;
    senders.sends[w] = ExchangePoint(senders.seen[w]);
    senders.sends[w].area = area;
  }
  return senders;
}

std::vector<double> middle_radiosity(const Senders& senders, View<double> radiosity) {
  std::vector<double> of_windows;
  for (const std::uint32_t i : senders.middle)
    for (std::size_t c = 0; c < 3; ++c)
      of_windows.push_back(radiosity[3 * i + c]);
  return of_windows;
}

std::vector<double> mean_radiosity(const ClusterTree& tree, const SenderWindows& windows, View<double> radiosity) {
  std::vector<double> of_windows;
  for (const SenderWindow& w : windows.windows) {
    double area = 0.0, flux[3] = {0.0, 0.0, 0.0};
    for (std::uint32_t k = w.first; k < w.first + w.count; ++k) {
      const std::uint32_t i = windows.members[k];
      area += double{tree.points[i].area};
      for (std::size_t c = 0; c < 3; ++c)
        flux[c] += radiosity[3 * i + c] * double{tree.points[i].area};
    }
    for (const double f : flux)
      of_windows.push_back(area > 0.0 ? f / area : 0.0);
  }
  return of_windows;
}

} // namespace pointgi
