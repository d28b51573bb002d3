#pragma once
/// The exchange of all pairs of points in double precision: what every faster way is measured by.
#include "fmm/operators/point_pair.h"
#include "octree/view.h"
#include <cstdint>
#include <functional>
#include <vector>

namespace pointgi {

/// Share of the light that passes between points i and j, in [0, 1].
using Visibility = std::function<double(std::uint32_t i, std::uint32_t j)>;

/// H [receivers x 3, W/m^2] = sum_j v_ij F_ij B_j at the points that `receivers` lists (method.md section 4, with
/// point_exchange() for F). radiosity [points x 3]. `visible` may be called by several threads at once and only for
/// pairs that face; empty: all is visible.
std::vector<double> direct_sum(View<Splat> points, View<double> radiosity, View<std::uint32_t> receivers,
                               const Visibility& visible = {});

} // namespace pointgi
