#include "octree/vmap/point_shares.h"
#include "octree/parallel.h"
#include "octree/vmap/facing.h"
#include "octree/vmap/pair_samples.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pointgi {

namespace {

/// Links that a thread takes at a time.
constexpr std::size_t grain = 16;

/// Of a link through which more light than epsilon goes, a point asks up to this many times as many segments.
constexpr float most_more_samples = 8.0f;

/// A point of one end of a link and the cluster at the other end.
template <class Use>
void for_ends(const ClusterTree& tree, const Link& link, const Use& use) {
  const Cluster &a = tree.nodes[link.a], &b = tree.nodes[link.b];
  for (std::uint32_t i = a.first_point; i < a.first_point + a.count; ++i)
    use(i, link.b);
  for (std::uint32_t i = b.first_point; i < b.first_point + b.count; ++i)
    use(i, link.a);
}

std::uint32_t ends_of(const ClusterTree& tree, const Link& link) {
  return tree.nodes[link.a].count + tree.nodes[link.b].count;
}

/// More than `epsilon` goes only between close leaves, where a point's share counts most.
unsigned samples_of(const ClusterTree& tree, const Link& link, const PointShareOptions& options) {
  const float exchange = exchange_bound(tree.nodes[link.a], tree.nodes[link.b]);
  const float more = exchange > options.epsilon ? std::min(exchange / options.epsilon, most_more_samples) : 1.0f;
  return std::min(static_cast<unsigned>(static_cast<float>(options.samples) * more), 255u);
}

/// Of some links: what is asked, and how often for each of their points.
struct Questions {
  std::vector<Segment> segments;
  std::vector<std::uint8_t> asked;
};

void answer(const ClusterTree& tree, const std::vector<const Link*>& partial, std::size_t first, std::size_t end,
            const Questions& questions, const std::uint8_t* blocked, std::vector<std::uint8_t>& shares) {
  const std::uint8_t* asked = questions.asked.data();
  for (std::size_t k = first; k < end; ++k) {
    const Link& link = *partial[k];
    std::uint8_t* share = shares.data() + link.point_shares;
    for (std::uint32_t i = 0; i < ends_of(tree, link); ++i, ++asked, ++share) {
      unsigned open = 0;
      for (unsigned s = 0; s < *asked; ++s)
        open += *blocked++ == 0;
      // No point of those looked at faces this one: it gets next to nothing through the link.
      const float seen = *asked == 0 ? link.visible : static_cast<float>(open) / static_cast<float>(*asked);
      *share = static_cast<std::uint8_t>(std::lround(255.0f * seen));
    }
  }
}

} // namespace

std::vector<std::uint8_t> make_point_shares(const ClusterTree& tree, std::vector<Link>& links, VisibilityOracle& oracle,
                                            const PointShareOptions& options, std::uint64_t& rays) {
  if (options.samples < 1 || options.samples > 255)
    throw std::invalid_argument("vmap: samples of a point must be from 1 to 255");
  std::vector<const Link*> partial;
  std::uint64_t all = 0;
  for (Link& link : links)
    if (link.visible < 1.0f && link.a != link.b) {
      if (all >= no_point_shares) throw std::length_error("vmap: more than 4 GiB of shares; a larger epsilon has less");
      link.point_shares = static_cast<std::uint32_t>(all);
      partial.push_back(&link);
      all += ends_of(tree, link);
    }
  std::vector<std::uint8_t> shares(all);
  const PairSamples samples(tree, options.seed, false);
  for (std::size_t first = 0; first < partial.size();) {
    std::size_t end = first;
    for (std::size_t asked = 0; end < partial.size() && asked < options.batch; ++end)
      asked += std::size_t{samples_of(tree, *partial[end], options)} * ends_of(tree, *partial[end]);
    const std::size_t ranges = (end - first + grain - 1) / grain;
    std::vector<Questions> questions(ranges);
    parallel_ranges(end - first, grain, [&](std::size_t from, std::size_t to) {
      Questions& q = questions[from / grain];
      for (std::size_t k = from; k < to; ++k) {
        const unsigned count = samples_of(tree, *partial[first + k], options);
        for_ends(tree, *partial[first + k], [&](std::uint32_t point, std::uint32_t other) {
          q.asked.push_back(static_cast<std::uint8_t>(samples.towards(point, other, count, 0, q.segments)));
        });
      }
    });
    std::vector<std::size_t> begin(ranges + 1);
    for (std::size_t r = 0; r < ranges; ++r)
      begin[r + 1] = begin[r] + questions[r].segments.size();
    std::vector<Segment> segments(begin.back());
    parallel_ranges(ranges, 1, [&](std::size_t r, std::size_t) {
      std::copy(questions[r].segments.begin(), questions[r].segments.end(),
                segments.begin() + static_cast<std::ptrdiff_t>(begin[r]));
    });
    const std::vector<std::uint8_t> blocked = oracle.blocked(segments);
    if (blocked.size() != segments.size()) throw std::logic_error("vmap: the oracle left segments unanswered");
    rays += segments.size();
    parallel_ranges(end - first, grain, [&](std::size_t from, std::size_t to) {
      answer(tree, partial, first + from, first + to, questions[from / grain], blocked.data() + begin[from / grain],
             shares);
    });
    first = end;
  }
  return shares;
}

} // namespace pointgi
