#include "host/radiosity/cones.h"
#include "host/passes/variant.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pointgi {

namespace {

constexpr std::size_t group = 64;
constexpr double first_points = 2000; ///< of a first launch, of which nothing is known yet

/// Cones at one angle to the normal.
struct Ring {
  unsigned count;
  double sine2; ///< of that angle
  double share; ///< of the irradiance, of all its cones
};

/// Quadratures over sine squared, by which cosine-weighted directions are even: Gauss' of two nodes; Radau's of two and
/// three, whose first node is the normal. One cone: the mean of the hemisphere.
const std::vector<std::vector<Ring>>& ring_sets() {
  const double root = std::sqrt(6.0);
  static const std::vector<std::vector<Ring>> all{
      {{1, 0.0, 1.0}},
      {{1, 0.0, 1.0 / 4.0}, {5, 2.0 / 3.0, 3.0 / 4.0}},
      {{3, 0.5 - std::sqrt(1.0 / 12.0), 0.5}, {6, 0.5 + std::sqrt(1.0 / 12.0), 0.5}},
      {{1, 0.0, 1.0 / 9.0},
       {5, (6.0 - root) / 10.0, (16.0 + root) / 36.0},
       {10, (6.0 + root) / 10.0, (16.0 - root) / 36.0}}};
  return all;
}

/// The widest half angle: at 60 degrees a cone about the normal has half of the hemisphere's solid angle.
constexpr double widest_cosine = 0.5;

} // namespace

std::vector<Cone> cone_set(unsigned count) {
  const auto has_count = [&](const std::vector<Ring>& rings) {
    unsigned cones = 0;
    for (const Ring& ring : rings)
      cones += ring.count;
    return cones == count;
  };
  const auto rings = std::find_if(ring_sets().begin(), ring_sets().end(), has_count);
  if (rings == ring_sets().end()) throw std::invalid_argument("cones: no set of " + std::to_string(count));
  std::vector<Cone> cones;
  double begin = 0.0; // sine squared where the part of the hemisphere begins that the ring stands for
  for (const Ring& ring : *rings) {
    const double end = begin + ring.share, sine = std::sqrt(ring.sine2);
    const double height = (std::sqrt(1.0 - begin) - std::sqrt(std::max(0.0, 1.0 - end))) / ring.count;
    const double cosine = std::max(widest_cosine, 1.0 - height); // of the half angle
    Cone cone{};
    cone.axis[2] = static_cast<float>(std::sqrt(1.0 - ring.sine2));
    cone.spread = static_cast<float>(2.0 * std::sqrt(1.0 - cosine * cosine) / cosine);
    cone.share = static_cast<float>(ring.share / ring.count);
    for (unsigned k = 0; k < ring.count; ++k) {
      const double angle = 6.283185307179586 * (k + 0.5) / ring.count;
      cone.axis[0] = static_cast<float>(sine * std::cos(angle));
      cone.axis[1] = static_cast<float>(sine * std::sin(angle));
      cones.push_back(cone);
    }
    begin = end;
  }
  return cones;
}

ConeExchange::ConeExchange(Session& session, View<Splat> points, View<std::uint32_t> places,
                           const VoxelOptions& options, unsigned cones)
    : session_(session), pyramid_(session, points, options), places_(places.begin(), places.end()),
      pace_(first_points, busy_work_items(session.info())) {
  if (places_.empty()) return;
  place_buffer_ = session.upload(places_);
  ConeGrid grid = pyramid_.grid();
  grid.cone_count = cones;
  grid_ = session.upload(&grid, 1);
  cones_ = session.upload(cone_set(cones));
  irradiance_ = session.allocate<cl_float>(3 * places_.size());
  const Program program = cones_program("radiosity/cones/trace.cl", pyramid_.texels());
  trace_ = session.kernel(program.file, program.options, "trace_cones");
}

DeviceCones ConeExchange::with_light(View<cl_float4> radiosity) {
  pyramid_.inject(radiosity);
  return {grid_, cones_, pyramid_.voxels(), pyramid_.cells(), pyramid_.texels()};
}

void ConeExchange::apply(View<double> radiosity, LinearisationPoint, std::vector<double>& irradiance) {
  if (radiosity.size != 3 * places_.size()) throw std::invalid_argument("radiosity is not [points x 3]");
  irradiance.clear();
  if (places_.empty()) return;
  std::vector<cl_float4> light(pyramid_.points().size);
  for (std::size_t k = 0; k < places_.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c)
      light[places_[k]].s[c] = static_cast<float>(radiosity[3 * k + c]);
  const DeviceCones lit = with_light(light);
  for_each_batch(EqualItems{places_.size()}, pace_, {}, [&](std::size_t first, std::size_t count) {
    const double seconds = session_.launch(trace_, LaunchShape::line(count, group), pyramid_.points(), place_buffer_,
                                           static_cast<cl_uint>(first), static_cast<cl_uint>(first + count), lit.grid,
                                           lit.cones, lit.voxels, lit.cells, irradiance_);
    trace_seconds_ += seconds;
    return seconds;
  });
  const std::vector<cl_float> found = session_.download(irradiance_, irradiance_.size);
  irradiance.assign(found.begin(), found.end());
}

} // namespace pointgi
