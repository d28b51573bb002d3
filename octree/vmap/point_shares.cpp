#include "octree/vmap/point_shares.h"
#include "octree/parallel.h"
#include "octree/vmap/pair_samples.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pointgi {

namespace {

/// Links that a thread takes at a time.
constexpr std::size_t grain = 16;

/// Near leaves ask every pair of their points, unless they hold more pairs than this (points in one place).
constexpr std::size_t most_pairs = 1u << 12;

std::uint32_t ends_of(const ClusterTree& tree, const Link& link) {
  return tree.nodes[link.a].count + tree.nodes[link.b].count;
}

bool asks_pairs(const ClusterTree& tree, const Link& link) {
  return link.kind == LinkKind::near_ && std::size_t{tree.nodes[link.a].count} * tree.nodes[link.b].count <= most_pairs;
}

/// Calls use(i, j) for the pairs of points of the link's ends that face each other.
template <class Use>
void for_pairs(const ClusterTree& tree, const Link& link, const Use& use) {
  const Cluster &a = tree.nodes[link.a], &b = tree.nodes[link.b];
  for (std::uint32_t i = a.first_point; i < a.first_point + a.count; ++i)
    for (std::uint32_t j = b.first_point; j < b.first_point + b.count; ++j)
      if (face_each_other(tree.points[i], tree.points[j])) use(i, j);
}

/// Calls use(point, other cluster) for the points of both ends.
template <class Use>
void for_ends(const ClusterTree& tree, const Link& link, const Use& use) {
  const Cluster &a = tree.nodes[link.a], &b = tree.nodes[link.b];
  for (std::uint32_t i = a.first_point; i < a.first_point + a.count; ++i)
    use(i, link.b);
  for (std::uint32_t i = b.first_point; i < b.first_point + b.count; ++i)
    use(i, link.a);
}

/// Of some links: what is asked, and for those that do not ask pairs how often for each of their points.
struct Questions {
  std::vector<Segment> segments;
  std::vector<std::uint8_t> asked;
};

class ShareMaker {
public:
  ShareMaker(const ClusterTree& tree, const PointShareOptions& options)
      : tree_(tree), options_(options), samples_(tree, options.seed, false) {}

  /// About how many segments a link asks.
  std::size_t cost(const Link& link) const {
    const Cluster &a = tree_.nodes[link.a], &b = tree_.nodes[link.b];
    return asks_pairs(tree_, link) ? std::size_t{a.count} * b.count
                                   : std::size_t{options_.samples} * ends_of(tree_, link);
  }

  void ask(const Link& link, Questions& q) const {
    if (asks_pairs(tree_, link)) {
      for_pairs(tree_, link, [&](std::uint32_t i, std::uint32_t j) { q.segments.push_back({i, j}); });
      return;
    }
    for_ends(tree_, link, [&](std::uint32_t point, std::uint32_t other) {
      q.asked.push_back(static_cast<std::uint8_t>(samples_.towards(point, other, options_.samples, 0, q.segments)));
    });
  }

  /// Takes the link's answers from `blocked` and how often was asked from `asked`; moves both behind them.
  void answer(const Link& link, const std::uint8_t*& blocked, const std::uint8_t*& asked, std::uint8_t* shares) const {
    if (asks_pairs(tree_, link)) {
      answer_pairs(link, blocked, shares);
      return;
    }
    for (std::uint32_t i = 0; i < ends_of(tree_, link); ++i, ++asked) {
      unsigned open = 0;
      for (unsigned s = 0; s < *asked; ++s)
        open += *blocked++ == 0;
      put(link, static_cast<float>(open), *asked, shares + i);
    }
  }

private:
  void answer_pairs(const Link& link, const std::uint8_t*& blocked, std::uint8_t* shares) const {
    const Cluster &a = tree_.nodes[link.a], &b = tree_.nodes[link.b];
    std::vector<float> open(ends_of(tree_, link)), all(open.size());
    for_pairs(tree_, link, [&](std::uint32_t i, std::uint32_t j) {
      const bool free = *blocked++ == 0;
      const auto add = [&](std::size_t end, std::uint32_t at, std::uint32_t from) {
        const float weight = exchange_weight(tree_.points[at], tree_.points[from]);
        all[end] += weight;
        if (free) open[end] += weight;
      };
      add(i - a.first_point, i, j);
      add(a.count + (j - b.first_point), j, i);
    });
    for (std::size_t i = 0; i < all.size(); ++i)
      put(link, open[i], all[i], shares + i);
  }

  /// Of a point that nothing of the other end faces, the link's share: it gets next to nothing.
  static void put(const Link& link, float open, float all, std::uint8_t* share) {
    *share = static_cast<std::uint8_t>(std::lround(255.0f * (all > 0.0f ? open / all : link.visible)));
  }

  const ClusterTree& tree_;
  PointShareOptions options_;
  PairSamples samples_;
};

/// Gives every partly visible link a place for its shares; these links and the length of all shares.
std::pair<std::vector<const Link*>, std::size_t> place_shares(const ClusterTree& tree, std::vector<Link>& links) {
  std::vector<const Link*> partial;
  std::size_t all = 0;
  for (Link& link : links)
    if (link.visible < 1.0f && link.a != link.b) {
      if (all >= no_point_shares) throw std::length_error("vmap: more than 4 GiB of shares; a larger epsilon has less");
      link.point_shares = static_cast<std::uint32_t>(all);
      partial.push_back(&link);
      all += ends_of(tree, link);
    }
  return {std::move(partial), all};
}

std::vector<Segment> joined(const std::vector<Questions>& questions, std::vector<std::size_t>& begin) {
  begin.assign(1, 0);
  for (const Questions& q : questions)
    begin.push_back(begin.back() + q.segments.size());
  std::vector<Segment> segments(begin.back());
  parallel_ranges(questions.size(), 1, [&](std::size_t r, std::size_t) {
    std::copy(questions[r].segments.begin(), questions[r].segments.end(),
              segments.begin() + static_cast<std::ptrdiff_t>(begin[r]));
  });
  return segments;
}

} // namespace

std::vector<std::uint8_t> make_point_shares(const ClusterTree& tree, std::vector<Link>& links, VisibilityOracle& oracle,
                                            const PointShareOptions& options, std::uint64_t& rays) {
  if (options.samples < 1 || options.samples > 255)
    throw std::invalid_argument("vmap: samples of a point must be from 1 to 255");
  const auto [partial, all] = place_shares(tree, links);
  std::vector<std::uint8_t> shares(all);
  const ShareMaker maker(tree, options);
  for (std::size_t first = 0, end; first < partial.size(); first = end) {
    end = first;
    for (std::size_t cost = 0; end < partial.size() && cost < options.batch; ++end)
      cost += maker.cost(*partial[end]);
    std::vector<Questions> questions((end - first + grain - 1) / grain);
    const View<const Link*> some{partial.data() + first, end - first};
    parallel_ranges(some.size, grain, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        maker.ask(*some[k], questions[from / grain]);
    });
    std::vector<std::size_t> begin;
    const std::vector<Segment> segments = joined(questions, begin);
    const std::vector<std::uint8_t> blocked = oracle.blocked(segments);
    if (blocked.size() != segments.size()) throw std::logic_error("vmap: the oracle left segments unanswered");
    rays += segments.size();
    parallel_ranges(some.size, grain, [&](std::size_t from, std::size_t to) {
      const std::uint8_t *answer = blocked.data() + begin[from / grain], *asked = questions[from / grain].asked.data();
      for (std::size_t k = from; k < to; ++k)
        maker.answer(*some[k], answer, asked, shares.data() + some[k]->point_shares);
    });
  }
  return shares;
}

} // namespace pointgi
