#pragma once
/// A closed room whose points all emit and reflect alike, and its solution.
#include "fmm/solve/solve.h"
#include "tests/support/exchange.h"
#include <memory>

namespace pointgi::test {

struct Room {
  ClusterTree tree;
  std::vector<Link> links;
  std::unique_ptr<RadiosityOperator> exchange;
  std::vector<float> area;

  /// make(tree, links) makes the operator.
  template <class Make>
  Room(const std::vector<Splat>& splats, const Make& make)
      : tree(build_clusters(splats, {})), links(links_without_visibility(tree)), exchange(make(tree, links)) {
    for (const Splat& s : tree.points)
      area.push_back(s.area);
  }
  std::size_t size() const { return area.size(); }

  Solution solve(const std::array<double, 3>& emission, const std::array<double, 3>& albedo,
                 const SolveOptions& options = {}) {
    std::vector<float> e, rho;
    for (std::size_t i = 0; i < size(); ++i)
      for (int c = 0; c < 3; ++c) {
        e.push_back(static_cast<float>(emission[c]));
        rho.push_back(static_cast<float>(albedo[c]));
      }
    return solve_radiosity(*exchange, e, rho, area, options);
  }
  double mean(const std::vector<double>& values, int colour) const {
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      sum += double{area[i]} * values[3 * i + colour];
      all += double{area[i]};
    }
    return sum / all;
  }
};

} // namespace pointgi::test
