#include "host/cloud/leaf_search.h"
#include <Eigen/Core>
#include <algorithm>
#include <limits>

namespace pointgi {

namespace {

// Densities differ from leaf to leaf and from site to site: looking a little farther than the last one needed saves
// looking twice.
constexpr float leaf_slack = 1.3f, site_slack = 1.25f;
constexpr float farthest2 = 1e38f;  // beyond every distance of local places
constexpr float smallest2 = 1e-30f; // whose inverse is far from overflow
constexpr float none = std::numeric_limits<float>::infinity();

} // namespace

void LeafSearch::go_to_leaf_of(const SiteTree& tree, std::uint32_t site) {
  const std::uint32_t leaf = tree.leaf_of(site);
  begin_ = tree.leaf_begin(leaf);
  end_ = tree.leaf_end(leaf);
  box_ = tree.leaf_box(leaf);
  reach2_ = 0.0f;
  crowded_ = false;
}

unsigned LeafSearch::search_tree(const SiteTree& tree, std::uint32_t site, unsigned k, Neighbour* out) {
  const unsigned count = tree.nearest(tree.place(site), k, site, out);
  last_reach_ = out[k - 1].distance2 / static_cast<float>(k);
  widest_ = std::max(widest_, last_reach_);
  return count;
}

/// Makes the sites of all leaves within the reach of this one's box candidates.
void LeafSearch::gather(const SiteTree& tree, float reach2) {
  unsigned count = 0;
  crowded_ = !tree.visit_near(box_, reach2, [&](std::uint32_t first, std::uint32_t past) {
    if (first == begin_) own_ = count;
    const SitePlaces& p = tree.places();
    for (std::uint32_t i = 0; i < past - first; ++i) {
      x_[count + i] = p.x[first + i];
      y_[count + i] = p.y[first + i];
      z_[count + i] = p.z[first + i];
      site_[count + i] = first + i;
    }
    count += past - first;
    return count < capacity;
  });
  candidates_ = count;
  reach2_ = reach2;
}

/// Collects the candidates within the limit in kept_. They are of few leaves: most blocks have none.
unsigned LeafSearch::select(float limit2) {
  unsigned found = 0;
  for (unsigned begin = 0; begin < candidates_; begin += block) {
    using Block = Eigen::Array<float, block, 1>;
    if (Block::Map(&distance2_[begin]).minCoeff() > limit2) continue;
    for (unsigned c = begin; c < begin + block; ++c) {
      kept_[found] = c;
      found += distance2_[c] <= limit2 ? 1u : 0u;
    }
  }
  return found;
}

/// On a surface squared distances are spread evenly: buckets of them hold one or two each, and what is left to put in
/// order within them is little.
void LeafSearch::order_few(unsigned found, float limit2, unsigned k, Neighbour* out) {
  constexpr unsigned buckets = 64;
  const float scale = buckets / limit2;
  std::array<std::uint8_t, buckets + 1> begin{};
  std::array<std::uint8_t, few> bucket;
  for (unsigned i = 0; i < found; ++i) {
    const auto b = std::min(static_cast<std::int32_t>(distance2_[kept_[i]] * scale), std::int32_t{buckets - 1});
    bucket[i] = static_cast<std::uint8_t>(b);
    ++begin[bucket[i] + 1u];
  }
  for (unsigned b = 1; b < buckets; ++b)
    begin[b] = static_cast<std::uint8_t>(begin[b] + begin[b - 1]);
  std::array<Neighbour, few> sorted;
  for (unsigned i = 0; i < found; ++i)
    sorted[begin[bucket[i]]++] = {site_[kept_[i]], distance2_[kept_[i]]};
  for (unsigned i = 1; i < found; ++i) {
    const Neighbour n = sorted[i];
    unsigned at = i;
    for (; at > 0 && sorted[at - 1].distance2 > n.distance2; --at)
      sorted[at] = sorted[at - 1];
    sorted[at] = n;
  }
  std::copy_n(sorted.begin(), k, out);
}

void LeafSearch::order_many(unsigned found, unsigned k, Neighbour* out) {
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return distance2_[a] != distance2_[b] ? distance2_[a] < distance2_[b] : a < b;
  };
  if (k < found) std::nth_element(kept_.begin(), kept_.begin() + k, kept_.begin() + found, before);
  std::sort(kept_.begin(), kept_.begin() + k, before);
  for (unsigned i = 0; i < k; ++i)
    out[i] = {site_[kept_[i]], distance2_[kept_[i]]};
}

unsigned LeafSearch::nearest(const SiteTree& tree, std::uint32_t site, unsigned k, Neighbour* out) {
  const bool same_tree = tree_ == tree.id(), follows = same_tree && site == last_site_ + 1;
  tree_ = tree.id();
  last_site_ = site;
  if (!same_tree || site < begin_ || site >= end_) {
    if (!follows) { // here and there: a leaf for each is not worth it
      begin_ = end_ = 0;
      widest_ = 0.0f;
      return search_tree(tree, site, k, out);
    }
    go_to_leaf_of(tree, site);
  }
  const auto places = static_cast<float>(k);
  if (reach2_ == 0.0f) {
    gather(tree, std::clamp(leaf_slack * widest_ * places, std::numeric_limits<float>::min(), farthest2));
    widest_ = 0.0f;
  }
  while (!crowded_) {
    measure(x_.data(), y_.data(), z_.data(), candidates_, tree.place(site), distance2_.data());
    distance2_[own_ + (site - begin_)] = none;
    std::fill_n(distance2_.begin() + candidates_, block, none);
    float limit2 = std::min(site_slack * last_reach_ * places, reach2_);
    unsigned found = select(limit2);
    if (found < k && limit2 < reach2_) found = select(limit2 = reach2_);
    if (found >= k) {
      if (found <= few && limit2 > smallest2)
        order_few(found, limit2, k, out);
      else
        order_many(found, k, out);
      last_reach_ = out[k - 1].distance2 / places;
      widest_ = std::max(widest_, last_reach_);
      return k;
    }
    if (reach2_ == farthest2) break;
    const float more = std::clamp(1.5f * places / static_cast<float>(found + 1), 1.5f, 16.0f);
    gather(tree, std::min(more * reach2_, farthest2));
  }
  return search_tree(tree, site, k, out);
}

} // namespace pointgi
