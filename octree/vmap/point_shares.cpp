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

/// More points than this never share an answer: a fraction of a leaf, or leaves show again.
constexpr std::size_t largest_group = 4;

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

/// Calls use(first, end, other cluster) for the points of both ends, in groups of at most `size` that stand one after
/// the other along the tree's curve. They begin elsewhere for each link, so that no two points share all answers.
template <class Use>
void for_groups(const ClusterTree& tree, const Link& link, std::uint32_t size, const Use& use) {
  const std::uint32_t shift = (link.a * 0x9e3779b9u + link.b * 0x85ebca6bu) >> 7;
  for (const auto& [receiver, source] : {std::pair{link.a, link.b}, std::pair{link.b, link.a}}) {
    const Cluster& c = tree.nodes[receiver];
    std::uint32_t first = c.first_point;
    for (std::uint32_t end = first + size - shift % size; first < c.first_point + c.count; first = end, end += size)
      use(first, end = std::min(end, c.first_point + c.count), source);
  }
}

/// Of some links: what is asked, and for those that do not ask pairs whether each of their groups did.
struct Questions {
  std::vector<Segment> segments;
  std::vector<std::uint8_t> asked; ///< 1, or 0 where nothing faces
};

class ShareMaker {
public:
  /// `partial`: all links that get shares.
  ShareMaker(const ClusterTree& tree, const std::vector<const Link*>& partial, const PointShareOptions& options)
      : tree_(tree), samples_(tree, options.seed, false) {
    std::size_t alone = 0;
    for (const Link* link : partial)
      if (!asks_pairs(tree, *link)) alone += ends_of(tree, *link);
    if (alone == 0) return;
    const std::size_t wanted = std::size_t{options.samples} * tree.points.size();
    group_ = static_cast<std::uint32_t>(std::clamp<std::size_t>((alone + wanted - 1) / wanted, 1, largest_group));
  }

  /// About how many segments a link asks.
  std::size_t cost(const Link& link) const {
    const Cluster &a = tree_.nodes[link.a], &b = tree_.nodes[link.b];
    return asks_pairs(tree_, link) ? std::size_t{a.count} * b.count : ends_of(tree_, link) / group_ + 2;
  }

  void ask(const Link& link, Questions& q) const {
    if (asks_pairs(tree_, link)) {
      for_pairs(tree_, link, [&](std::uint32_t i, std::uint32_t j) { q.segments.push_back({i, j}); });
      return;
    }
    for_groups(tree_, link, group_, [&](std::uint32_t first, std::uint32_t end, std::uint32_t other) {
      const std::uint32_t point = first + (other * 0x9e3779b9u >> 8) % (end - first);
      q.asked.push_back(static_cast<std::uint8_t>(samples_.towards(point, other, 1, 0, q.segments)));
    });
  }

  /// Takes the link's answers from `blocked` and how often was asked from `asked`; moves both behind them.
  void answer(const Link& link, const std::uint8_t*& blocked, const std::uint8_t*& asked, std::uint8_t* shares) const {
    if (asks_pairs(tree_, link)) {
      answer_pairs(link, blocked, shares);
      return;
    }
    for_groups(tree_, link, group_, [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
      put(link, *asked != 0 && *blocked == 0 ? 1.0f : 0.0f, *asked, shares);
      std::fill_n(shares, end - first, *shares);
      shares += end - first;
      blocked += *asked++;
    });
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
  PairSamples samples_;
  std::uint32_t group_ = 1; ///< points that share an answer
};

/// Gives every link that is not open a place for its shares; these links and the length of all shares.
std::pair<std::vector<const Link*>, std::size_t> place_shares(const ClusterTree& tree, std::vector<Link>& links) {
  std::vector<const Link*> partial;
  std::size_t all = 0;
  for (Link& link : links)
    if (!link.open && link.a != link.b) {
      if (all + ends_of(tree, link) > no_point_shares)
        throw std::length_error("vmap: more than 4 GiB of shares; a larger epsilon has less");
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
  if (options.samples < 1) throw std::invalid_argument("vmap: a point must ask at least one segment");
  const auto placed = place_shares(tree, links);
  const std::vector<const Link*>& partial = placed.first;
  std::vector<std::uint8_t> shares(placed.second);
  const ShareMaker maker(tree, partial, options);
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
