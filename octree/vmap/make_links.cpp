#include "octree/vmap/make_links.h"
#include "octree/clock.h"
#include "octree/mixed_bits.h"
#include "octree/parallel.h"
#include "octree/vmap/facing.h"
#include "octree/vmap/pair_samples.h"
#include "octree/vmap/point_shares.h"
#include "octree/vmap/shafts.h"
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace pointgi {

namespace {

/// Pairs that a thread takes at a time.
constexpr std::size_t grain = 256;

/// Leaves with more pairs of points than this are not searched for two that face each other.
constexpr std::uint64_t exhaustive_pairs = 1u << 16;

/// A pair that exchanges more light than epsilon is asked up to this many times K segments.
constexpr float most_more_samples = 16.0f;

/// What has been asked of a pair so far.
enum class Stage : std::uint8_t {
  fresh,
  all_blocked, ///< all segments: asked again with four times as many before it is dropped
  leaves       ///< two leaves that exchange light point by point
};

struct Pair {
  std::uint32_t a = 0, b = 0; ///< a <= b
  Stage stage = Stage::fresh;
};

/// What the bounds say of a pair, and what it asks.
struct Question {
  enum Kind : std::uint8_t {
    dropped,
    divided,
    self,      ///< a leaf with itself
    whole,     ///< can it be linked as it is?
    point_wise ///< what share of two leaves' points see each other?
  };
  Kind kind = dropped;
  bool small = false;      ///< light below epsilon
  bool all_facing = false; ///< the far form, without clamps, is allowed
  Obstacles between = Obstacles::own;
  bool faces = false;         ///< two points that face each other were found
  std::uint32_t segments = 0; ///< asked
};

/// A range's share of what a wave puts out.
struct Output {
  std::vector<Link> links;
  std::vector<Pair> next;
};

/// Puts the ranges' lists one after the other: the order is the wave's, however many threads there were.
template <typename T, typename Part, typename Get>
std::vector<T> joined(const std::vector<Part>& parts, const Get& get) {
  std::vector<std::size_t> first(parts.size() + 1);
  for (std::size_t p = 0; p < parts.size(); ++p)
    first[p + 1] = first[p] + get(parts[p]).size();
  std::vector<T> all(first.back());
  parallel_ranges(parts.size(), 1, [&](std::size_t p, std::size_t) {
    std::copy(get(parts[p]).begin(), get(parts[p]).end(), all.begin() + static_cast<std::ptrdiff_t>(first[p]));
  });
  return all;
}

class LinkMaker {
public:
  LinkMaker(const ClusterTree& tree, VisibilityOracle& oracle, const LinkOptions& options, View<Splat> obstacles)
      : tree_(tree), oracle_(oracle), options_(options), samples_(tree, options.seed, options.thesis) {
    // Discs of a bent surface fill the shafts of its own clusters: 1.6 times the rays of a scan, for nothing found.
    if (!options.thesis && std::any_of(obstacles.begin(), obstacles.end(), is_flat)) shafts_.emplace(obstacles);
  }

  /// run() of a sample: of each wave at most so many pairs.
  LinkEstimate estimate(std::size_t pairs_a_wave) {
    options_.most_rays = 0;
    sampled_ = pairs_a_wave;
    run();
    const double wanted = static_cast<double>(options_.point_samples) * static_cast<double>(tree_.points.size());
    if (options_.point_samples > 0 && !options_.thesis) {
      const double shared = near_pairs_ + asks_alone_ / std::clamp(std::ceil(asks_alone_ / wanted), 1.0, 4.0);
      estimate_.rays += shared;
      if (map_.statistics.rays > 0)
        estimate_.seconds += shared * oracle_seconds_ / static_cast<double>(map_.statistics.rays);
    }
    return estimate_;
  }

  VMap run() {
    std::vector<Pair> wave;
    if (tree_.nodes[0].count > 0) wave.push_back({});
    const std::size_t pairs_at_once = std::max<std::size_t>(grain, options_.batch / (4 * options_.samples));
    while (!wave.empty()) {
      coarse_ = coarse_ || exceeds_most_rays(wave.size());
      ++map_.statistics.waves;
      map_.statistics.coarse_waves += coarse_ ? 1 : 0;
      const std::uint64_t rays = map_.statistics.rays;
      std::vector<Pair> next;
      const Clock::time_point began = Clock::now();
      for (std::size_t begin = 0; begin < wave.size(); begin += pairs_at_once)
        treat({wave.data() + begin, std::min(pairs_at_once, wave.size() - begin)}, next);
      estimate_.seconds += weight_ * seconds_since(began);
      rays_a_pair_ = static_cast<double>(map_.statistics.rays - rays) / static_cast<double>(wave.size());
      wave = std::move(next);
      if (sampled_ > 0 && wave.size() > sampled_) thin(wave);
    }
    return std::move(map_);
  }

private:
  /// Whether a wave of so many pairs would, if each asks as much as those of the wave before.
  bool exceeds_most_rays(std::size_t pairs) const {
    return options_.most_rays > 0 &&
           static_cast<double>(map_.statistics.rays) + rays_a_pair_ * static_cast<double>(pairs) >
               static_cast<double>(options_.most_rays);
  }

  /// Keeps about sampled_ pairs at even distances, from a random one on, which stand for all: pairs of one region
  /// follow each other.
  void thin(std::vector<Pair>& wave) {
    const double share = static_cast<double>(sampled_) / static_cast<double>(wave.size());
    double at = uniform_of(options_.seed + (std::uint64_t{map_.statistics.waves} << 32));
    std::vector<Pair> kept;
    for (const Pair& pair : wave)
      if ((at += share) >= 1.0) {
        at -= 1.0;
        kept.push_back(pair);
      }
    if (kept.empty()) kept.push_back(wave.back()); // the rounding of a million sums
    weight_ *= static_cast<double>(wave.size()) / static_cast<double>(kept.size());
    wave = std::move(kept);
  }

  /// Adds what a part of a wave asked and made, times what each of its pairs stands for.
  void add_to_estimate(std::size_t pairs, std::size_t rays, const std::vector<Link>& links) {
    estimate_.pairs += weight_ * static_cast<double>(pairs);
    estimate_.rays += weight_ * static_cast<double>(rays);
    estimate_.links += weight_ * static_cast<double>(links.size());
    estimate_.bytes += weight_ * static_cast<double>(links.size() * sizeof(Link));
    for (const Link& link : links) {
      if (link.open || link.a == link.b) continue;
      const double a = tree_.nodes[link.a].count, b = tree_.nodes[link.b].count;
      estimate_.bytes += weight_ * (a + b);
      if (link.kind == LinkKind::near_)
        near_pairs_ += 0.5 * weight_ * a * b; // of which half face each other
      else
        asks_alone_ += weight_ * (a + b);
    }
  }

  bool is_leaf(std::uint32_t n) const { return tree_.nodes[n].first_child == 0; }

  /// Classifies, asks, decides: one part of a wave.
  void treat(View<Pair> pairs, std::vector<Pair>& next) {
    const std::size_t ranges = (pairs.size + grain - 1) / grain;
    std::vector<Question> questions(pairs.size);
    std::vector<std::vector<Segment>> asked(ranges);
    parallel_ranges(pairs.size, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        questions[i] = classify(pairs[i], asked[begin / grain]);
    });
    const auto segments = joined<Segment>(
        asked, [](const auto& part) -> const auto& { return part; });
    std::vector<std::size_t> first(ranges + 1);
    for (std::size_t r = 0; r < ranges; ++r)
      first[r + 1] = first[r] + asked[r].size();
    asked = {};
    std::vector<std::uint8_t> blocked;
    const Clock::time_point asking = Clock::now();
    if (!segments.empty()) blocked = oracle_.blocked(segments);
    oracle_seconds_ += seconds_since(asking);
    if (blocked.size() != segments.size()) throw std::logic_error("vmap: the oracle left segments unanswered");

    std::vector<Output> outputs(ranges);
    parallel_ranges(pairs.size, grain, [&](std::size_t begin, std::size_t end) {
      auto answer = blocked.begin() + static_cast<std::ptrdiff_t>(first[begin / grain]);
      for (std::size_t i = begin; i < end; ++i) {
        const auto last = answer + questions[i].segments;
        decide(pairs[i], questions[i], static_cast<std::uint32_t>(std::count(answer, last, std::uint8_t{0})),
               outputs[begin / grain]);
        answer = last;
      }
    });
    collect(pairs, segments.size(), outputs, next);
  }

  void collect(View<Pair> pairs, std::size_t rays, const std::vector<Output>& outputs, std::vector<Pair>& next) {
    LinkStatistics& s = map_.statistics;
    s.rays += rays;
    for (const Pair& p : pairs)
      s.pairs_tested += p.stage == Stage::fresh;
    const auto links = joined<Link>(
        outputs, [](const Output& o) -> const auto& { return o.links; });
    for (const Link& link : links)
      ++(link.kind == LinkKind::far ? s.far : link.kind == LinkKind::mid ? s.mid : s.near_);
    if (sampled_ > 0)
      add_to_estimate(pairs.size, rays, links);
    else
      map_.links.insert(map_.links.end(), links.begin(), links.end());
    const auto more = joined<Pair>(
        outputs, [](const Output& o) -> const auto& { return o.next; });
    next.insert(next.end(), more.begin(), more.end());
  }

  Question classify(const Pair& pair, std::vector<Segment>& segments) const {
    const Cluster &a = tree_.nodes[pair.a], &b = tree_.nodes[pair.b];
    Question q;
    if (pair.a == pair.b) {
      q.kind = is_leaf(pair.a) ? Question::self : Question::divided;
      return q;
    }
    const Facing from_a = facing(a, b), from_b = facing(b, a);
    if (from_a == Facing::none || from_b == Facing::none) return q;
    q.all_facing = from_a == Facing::all && from_b == Facing::all;
    const bool separated = well_separated(a, b, options_.separation);
    const float exchange = exchange_bound(a, b);
    q.small = separated && (coarse_ || exchange < options_.epsilon);
    if (pair.stage != Stage::leaves && separated && (q.all_facing || q.small))
      q.kind = Question::whole;
    else
      q.kind = is_leaf(pair.a) && is_leaf(pair.b) ? Question::point_wise : Question::divided;
    if (q.kind == Question::divided) return q;
    if (shafts_) q.between = pair.stage == Stage::all_blocked ? Obstacles::some : shafts_->between(a, b);
    std::vector<Segment> unasked;
    const bool open = q.between == Obstacles::none;
    const std::uint32_t found = ask(pair, q.kind == Question::point_wise, exchange, open ? unasked : segments);
    q.faces = found > 0;
    if (!open) q.segments = found;
    return q;
  }

  /// Segments of a pair: the more light goes between the two, the more a hidden part that no segment meets would cost.
  std::uint32_t samples_for(const Pair& pair, bool point_wise, float exchange) const {
    if (point_wise) return 2 * options_.samples;
    const float more =
        exchange > options_.epsilon && !coarse_ ? std::min(exchange / options_.epsilon, most_more_samples) : 1.0f;
    const auto count = static_cast<std::uint32_t>(static_cast<float>(options_.samples) * more);
    return pair.stage == Stage::all_blocked ? 4 * count : count;
  }

  std::uint32_t ask(const Pair& pair, bool point_wise, float exchange, std::vector<Segment>& segments) const {
    if (options_.thesis) return samples_.central(pair.a, pair.b, segments);
    const std::uint32_t count = samples_for(pair, point_wise, exchange);
    const std::uint32_t taken =
        samples_.stratified(pair.a, pair.b, count, static_cast<std::uint32_t>(pair.stage), segments);
    if (taken > 0 || !point_wise || !searchable(pair)) return taken;
    return samples_.exhaustive(pair.a, pair.b, count, segments);
  }

  bool searchable(const Pair& pair) const {
    return std::uint64_t{tree_.nodes[pair.a].count} * tree_.nodes[pair.b].count <= exhaustive_pairs;
  }

  /// `open`: how many of the pair's segments nothing blocks.
  void decide(const Pair& pair, const Question& q, std::uint32_t open, Output& out) const {
    switch (q.kind) {
    case Question::dropped:
      return;
    case Question::self:
      out.links.push_back({pair.a, pair.b, 1.0f, LinkKind::near_, no_point_shares, true});
      return;
    case Question::divided:
      divide(pair, out);
      return;
    case Question::whole:
      decide_whole(pair, q, open, out);
      return;
    case Question::point_wise:
      // None found that face each other: there are none, or too many pairs to know; then the clamps will tell.
      if (!q.faces && searchable(pair)) return;
      if (q.segments == 0 || open > 0) out.links.push_back(link(pair, q, open, LinkKind::near_));
      return;
    }
  }

  static float share(const Question& q, std::uint32_t open) {
    return q.segments == 0 ? 1.0f : static_cast<float>(open) / static_cast<float>(q.segments);
  }

  static Link link(const Pair& pair, const Question& q, std::uint32_t open, LinkKind kind) {
    const float visible = share(q, open);
    return {pair.a, pair.b, visible, kind, no_point_shares, visible == 1.0f && q.between != Obstacles::some};
  }

  void decide_whole(const Pair& pair, const Question& q, std::uint32_t open, Output& out) const {
    const float visible = share(q, open);
    const bool retested = pair.stage == Stage::all_blocked;
    if (q.small && (!q.faces || ((options_.thesis || coarse_) && visible == 0.0f))) return;
    if (visible == 0.0f && !options_.thesis) {
      // Behind a wall, or almost: what is dropped wrongly all points of the pair miss, and their cluster shows.
      if (!retested) out.next.push_back({pair.a, pair.b, Stage::all_blocked});
      return;
    }
    if (q.small || (visible == 1.0f && !retested)) {
      out.links.push_back(link(pair, q, open, q.all_facing ? LinkKind::far : LinkKind::mid));
      return;
    }
    // One segment of the thesis says nothing of the others when it is blocked: it goes down to the leaves.
    if (is_leaf(pair.a) && is_leaf(pair.b))
      out.next.push_back({pair.a, pair.b, Stage::leaves});
    else
      divide(pair, out);
  }

  /// The larger node descends; a leaf waits for the other.
  void divide(const Pair& pair, Output& out) const {
    const Cluster &a = tree_.nodes[pair.a], &b = tree_.nodes[pair.b];
    if (pair.a == pair.b) {
      for (std::uint32_t i = 0; i < a.child_count; ++i)
        for (std::uint32_t j = i; j < a.child_count; ++j)
          out.next.push_back({a.first_child + i, a.first_child + j, Stage::fresh});
      return;
    }
    const bool first = is_leaf(pair.b) || (!is_leaf(pair.a) && a.radius >= b.radius);
    const Cluster& parent = first ? a : b;
    const std::uint32_t other = first ? pair.b : pair.a;
    for (std::uint32_t k = 0; k < parent.child_count; ++k) {
      const std::uint32_t child = parent.first_child + k;
      out.next.push_back({std::min(child, other), std::max(child, other), Stage::fresh});
    }
  }

  const ClusterTree& tree_;
  VisibilityOracle& oracle_;
  LinkOptions options_;
  PairSamples samples_;
  std::optional<Shafts> shafts_;
  bool coarse_ = false;     ///< most_rays is reached: from now on no pair that is far apart is divided
  double rays_a_pair_ = 0;  ///< that the wave before asked
  std::size_t sampled_ = 0; ///< pairs of a wave, at most; 0: all
  double weight_ = 1.0;     ///< pairs that each of the wave stands for
  LinkEstimate estimate_;
  double oracle_seconds_ = 0.0;
  double asks_alone_ = 0.0, near_pairs_ = 0.0; ///< segments of point_shares: a point each, a pair of points each
  VMap map_;
};

} // namespace

namespace {

void check(const LinkOptions& options) {
  if (options.samples < 1 || options.samples > 1024)
    throw std::invalid_argument("vmap: samples must be from 1 to 1024");
  if (!(options.epsilon >= 0.0f)) throw std::invalid_argument("vmap: epsilon must not be negative");
  if (!(options.separation > 0.0f && options.separation <= 1.0f))
    throw std::invalid_argument("vmap: separation must be above 0 and at most 1");
}

} // namespace

LinkEstimate estimate_links(const ClusterTree& tree, VisibilityOracle& oracle, const LinkOptions& options,
                            View<Splat> obstacles, std::size_t pairs_a_wave) {
  check(options);
  return LinkMaker(tree, oracle, options, obstacles).estimate(std::max<std::size_t>(1, pairs_a_wave));
}

VMap make_links(const ClusterTree& tree, VisibilityOracle& oracle, const LinkOptions& options, View<Splat> obstacles) {
  check(options);
  VMap map = LinkMaker(tree, oracle, options, obstacles).run();
  if (options.point_samples > 0 && !options.thesis)
    map.point_shares = make_point_shares(tree, map.links, oracle, {options.point_samples, options.seed, options.batch},
                                         map.statistics.rays);
  return map;
}

} // namespace pointgi
