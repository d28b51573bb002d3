#include "host/photon/photon_map.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace pointgi {

namespace {

constexpr std::size_t bucket_grain = 256, node_grain = 256;

/// Photons [first, last) that share a subtree of `buckets` buckets.
struct Part {
  std::size_t first, last;
};

/// The axis along which the photons spread most.
int widest_axis(const Photon* photons, Part part) {
  float low[3], high[3];
  for (int a = 0; a < 3; ++a)
    low[a] = high[a] = photons[part.first].position[a];
  for (std::size_t i = part.first + 1; i < part.last; ++i)
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], photons[i].position[a]);
      high[a] = std::max(high[a], photons[i].position[a]);
    }
  int widest = 0;
  for (int a = 1; a < 3; ++a)
    if (high[a] - low[a] > high[widest] - low[widest]) widest = a;
  return widest;
}

/// Brings the photons into the order of the buckets. A part of more than `half` photons is divided behind its first
/// `half`: the left side is full, which is what keeps the tree without pointers.
void sort_into_buckets(Pool<Photon>& photons, unsigned levels) {
  std::vector<Part> parts{{0, photons.size()}};
  for (std::size_t half = PHOTON_LANES * (std::size_t{1} << (3 * levels)) / 2; half >= PHOTON_LANES; half /= 2) {
    parallel_ranges(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Part part = parts[k];
        if (part.last - part.first <= half) continue;
        const int axis = widest_axis(photons.data(), part);
        const auto at = [&](std::size_t i) { return photons.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(part.first), at(part.first + half), at(part.last),
                         [axis](const Photon& a, const Photon& b) { return a.position[axis] < b.position[axis]; });
      }
    });
    std::vector<Part> next;
    for (const Part part : parts) {
      const std::size_t middle = std::min(part.first + half, part.last);
      next.push_back({part.first, middle});
      if (middle < part.last) next.push_back({middle, part.last});
    }
    parts = std::move(next);
  }
}

void fill_bucket(const Photon* photons, std::size_t count, float* words) {
  for (std::size_t lane = 0; lane < PHOTON_LANES; ++lane) {
    const bool there = lane < count;
    for (int a = 0; a < 3; ++a) {
      words[a * PHOTON_LANES + lane] = there ? photons[lane].position[a] : PHOTON_NOWHERE;
      words[(4 + a) * PHOTON_LANES + lane] = there ? photons[lane].power[a] : 0.0f;
    }
    const pg_uint inward = there ? photons[lane].inward : 0u;
    std::memcpy(&words[3 * PHOTON_LANES + lane], &inward, sizeof inward);
  }
}

struct Box {
  float low[3] = {PHOTON_NOWHERE, PHOTON_NOWHERE, PHOTON_NOWHERE};
  float high[3] = {-PHOTON_NOWHERE, -PHOTON_NOWHERE, -PHOTON_NOWHERE};
};

Box box_of_bucket(const PhotonMap& map, std::size_t bucket) {
  Box box;
  const float* words = &map.buckets[bucket * PHOTON_BUCKET_WORDS];
  const std::size_t count = std::min<std::size_t>(PHOTON_LANES, map.photons - bucket * PHOTON_LANES);
  for (int a = 0; a < 3; ++a)
    for (std::size_t lane = 0; lane < count; ++lane) {
      box.low[a] = std::min(box.low[a], words[a * PHOTON_LANES + lane]);
      box.high[a] = std::max(box.high[a], words[a * PHOTON_LANES + lane]);
    }
  return box;
}

Box box_of_node(const PhotonNode& node) {
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.low[a] = *std::min_element(node.low[a], node.low[a] + PHOTON_CHILDREN);
    box.high[a] = *std::max_element(node.high[a], node.high[a] + PHOTON_CHILDREN);
  }
  return box;
}

std::size_t first_of_level(unsigned level) {
  return ((std::size_t{1} << (3 * level)) - 1) / 7;
}

/// Boxes from the buckets upwards. Nodes that the numbering leaves room for and that hold nothing stay inverted.
void measure_nodes(PhotonMap& map) {
  const std::size_t last = first_of_level(map.levels - 1);
  map.nodes.resize(last + (map.bucket_count() + PHOTON_CHILDREN - 1) / PHOTON_CHILDREN);
  std::size_t below = map.bucket_count(); // children that are there
  for (unsigned level = map.levels; level-- > 0;) {
    const std::size_t first = first_of_level(level);
    const std::size_t room = std::min(first_of_level(level + 1), map.nodes.size()) - first;
    parallel_ranges(room, node_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t c = 0; c < PHOTON_CHILDREN; ++c) {
          const std::size_t child = PHOTON_CHILDREN * k + c;
          Box box;
          if (child < below)
            box = level + 1 == map.levels ? box_of_bucket(map, child)
                                          : box_of_node(map.nodes[first_of_level(level + 1) + child]);
          for (int a = 0; a < 3; ++a) {
            map.nodes[first + k].low[a][c] = box.low[a];
            map.nodes[first + k].high[a][c] = box.high[a];
          }
        }
    });
    below = (below + PHOTON_CHILDREN - 1) / PHOTON_CHILDREN;
  }
}

} // namespace

PhotonMap build_photon_map(View<Photon> photons) {
  PhotonMap map;
  map.photons = photons.size;
  if (photons.size == 0) return map;
  for (const Photon& p : photons)
    if (!std::isfinite(p.position[0]) || !std::isfinite(p.position[1]) || !std::isfinite(p.position[2]))
      throw std::invalid_argument("photon map: a photon's position is not finite");
  const std::size_t buckets = (photons.size + PHOTON_LANES - 1) / PHOTON_LANES;
  map.levels = 1;
  while ((std::size_t{1} << (3 * map.levels)) < buckets)
    ++map.levels;
  Pool<Photon> sorted(photons.size);
  std::copy(photons.begin(), photons.end(), sorted.begin());
  sort_into_buckets(sorted, map.levels);
  map.buckets.resize(buckets * PHOTON_BUCKET_WORDS);
  parallel_ranges(buckets, bucket_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      fill_bucket(&sorted[b * PHOTON_LANES], std::min<std::size_t>(PHOTON_LANES, photons.size - b * PHOTON_LANES),
                  &map.buckets[b * PHOTON_BUCKET_WORDS]);
  });
  measure_nodes(map);
  return map;
}

pg_uint packed_direction(const float direction[3]) {
  pg_uint packed = 0;
  for (int a = 0; a < 3; ++a) {
    const float c = std::min(std::max(direction[a], -1.0f), 1.0f) * PHOTON_DIRECTION_SCALE;
    packed |= (static_cast<pg_uint>(static_cast<int>(std::nearbyint(c))) & 1023u) << (10 * a);
  }
  return packed;
}

void unpack_direction(pg_uint packed, float direction[3]) {
  for (int a = 0; a < 3; ++a) {
    const int bits = static_cast<int>((packed >> (10 * a)) & 1023u);
    direction[a] = static_cast<float>(bits >= 512 ? bits - 1024 : bits) / PHOTON_DIRECTION_SCALE;
  }
}

} // namespace pointgi
