#include "host/radiosity/plan.h"
#include "fmm/operators/point_pair.h"
#include "octree/parallel.h"
#include "octree/vmap/facing.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Looks at two points that a look at two clusters is worth; those that the bound of a scene may take a point, and in
/// all: a ball takes some 800 a point, and what is nearly flat but noisy would take all pairs. 1e8 take about 1 s.
constexpr std::uint64_t work_of_clusters = 8, work_a_point = 1500, work_at_most = 100'000'000;
constexpr std::uint64_t steps_between_asks = 4096; ///< about a tenth of a second

std::string millions(double rays) {
  char text[40];
  std::snprintf(text, sizeof text, rays < 1e7 ? "%.1f million" : "%.0f million", 1e-6 * rays);
  return text;
}

/// Sums up to `enough`, over pairs of clusters: power that one sends times what of it the other may get.
class ExchangeBound {
public:
  ExchangeBound(const ClusterTree& tree, View<float> radiosity) : tree_(tree), flux_(tree.nodes.size()) {
    point_flux_.reserve(tree.points.size());
    for (std::size_t i = 0; i < tree.points.size(); ++i)
      point_flux_.push_back((double{radiosity[3 * i]} + double{radiosity[3 * i + 1]} + double{radiosity[3 * i + 2]}) *
                            double{tree.points[i].area});
    for (std::size_t node = 0; node < tree.nodes.size(); ++node) {
      const Cluster& c = tree.nodes[node];
      for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i)
        flux_[node] += point_flux_[i];
    }
  }

  double sent() const { return flux_.empty() ? 0.0 : flux_[0]; }

  /// Infinity where it cannot be told in about `most_work` looks at two points.
  double received(double enough, std::uint64_t most_work) {
    std::vector<std::array<std::uint32_t, 2>> waiting{{0, 0}};
    std::uint64_t steps = 0;
    while (!waiting.empty() && received_ <= enough) {
      work_ += work_of_clusters;
      if (work_ > most_work) return std::numeric_limits<double>::infinity();
      if (++steps % steps_between_asks == 0) ask_now();
      const auto [ka, kb] = waiting.back();
      waiting.pop_back();
      take(ka, kb, waiting);
    }
    return received_;
  }

private:
  void take(std::uint32_t ka, std::uint32_t kb, std::vector<std::array<std::uint32_t, 2>>& waiting) {
    const Cluster &a = tree_.nodes[ka], &b = tree_.nodes[kb];
    if (flux_[ka] == 0.0 && flux_[kb] == 0.0) return;
    const Facing of_a = facing(a, b), of_b = facing(b, a);
    if (ka != kb && (of_a == Facing::none || of_b == Facing::none)) return;
    double square = 0.0;
    for (int k = 0; k < 3; ++k)
      square += (double{b.centre[k]} - a.centre[k]) * (double{b.centre[k]} - a.centre[k]);
    const double nearest = std::sqrt(square) - a.radius - b.radius;
    // Where bounds do not know whether any two points face each other, they are asked: those of a ball do not.
    if (of_a == Facing::all && of_b == Facing::all && nearest > double{a.radius} + b.radius) {
      received_ += (flux_[ka] * double{b.area} + flux_[kb] * double{a.area}) / (pi * nearest * nearest);
      return;
    }
    if (a.child_count == 0 && b.child_count == 0) {
      take_points(a, b, ka == kb);
      return;
    }
    const bool first = b.child_count == 0 || (a.child_count != 0 && a.radius >= b.radius);
    const Cluster& parent = first ? a : b;
    for (std::uint32_t i = parent.first_child; i < parent.first_child + parent.child_count; ++i)
      if (ka == kb)
        for (std::uint32_t j = i; j < parent.first_child + parent.child_count; ++j)
          waiting.push_back({i, j});
      else
        waiting.push_back({i, first ? kb : ka});
  }

  void take_points(const Cluster& a, const Cluster& b, bool same) {
    work_ += std::uint64_t{a.count} * b.count;
    for (std::uint32_t i = a.first_point; i < a.first_point + a.count; ++i)
      for (std::uint32_t j = same ? i + 1 : b.first_point; j < b.first_point + b.count; ++j) {
        const ExchangePoint p(tree_.points[i]), q(tree_.points[j]);
        if (!(p.area > 0.0) || !(q.area > 0.0)) continue;
        received_ += point_flux_[j] / q.area * point_exchange(p, q) * p.area +
                     point_flux_[i] / p.area * point_exchange(q, p) * q.area;
      }
  }

  const ClusterTree& tree_;
  std::vector<double> flux_, point_flux_; ///< of all colours together
  double received_ = 0.0;
  std::uint64_t work_ = 0;
};

} // namespace

double bound_of_exchange(const ClusterTree& tree, View<float> radiosity, double albedo, double enough) {
  if (tree.points.empty()) return 0.0;
  ExchangeBound bound(tree, radiosity);
  if (!(bound.sent() > 0.0)) return 0.0;
  // Of what is received once a part is sent again: at most the albedo of it, and so on.
  const double again = albedo / std::max(1e-3, 1.0 - albedo);
  return bound.received(enough * bound.sent() / again,
                        std::min<std::uint64_t>(work_at_most, work_a_point * tree.points.size())) *
         again / bound.sent();
}

MethodPlan plan_method(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                       const RadiosityMap& clusters, bool emitters_exchange) {
  MethodPlan plan{radiosity_method("fmm"), {}, estimate_visibility(session, scene, settings, clusters)};
  const double directions = static_cast<double>(clusters.place.size()) * settings.directions;
  char factor[80];
  std::snprintf(factor, sizeof factor, "; directions are taken above %g times theirs", dearer_factor);
  plan.reason = "the V-map would ask about " + millions(plan.vmap.rays) + " rays, " +
                std::to_string(settings.directions) + " directions a point " + millions(directions) + factor;
  if (plan.vmap.rays <= dearer_factor * directions) return plan;
  if (emitters_exchange)
    plan.reason += "; lamps that take part in the exchange are too small for directions";
  else
    plan.method = radiosity_method("directions");
  return plan;
}

} // namespace pointgi
