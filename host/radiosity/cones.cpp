#include "host/radiosity/cones.h"
#include "host/passes/variant.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pointgi {

namespace {

constexpr std::size_t group = 64;
constexpr double first_points = 2000; ///< of a first launch, of which nothing is known yet

/// Cones of each ring, the innermost first.
const std::vector<std::vector<unsigned>>& ring_sets() {
  static const std::vector<std::vector<unsigned>> all{{1}, {1, 5}, {3, 6}, {1, 5, 10}};
  return all;
}

unsigned count_of(const std::vector<unsigned>& rings) {
  unsigned count = 0;
  for (const unsigned ring : rings)
    count += ring;
  return count;
}

/// The widest half angle: at 60 degrees a cone about the normal has half of the hemisphere's solid angle.
constexpr double widest_cosine = 0.5;

} // namespace

std::vector<Cone> cone_set(unsigned count) {
  const auto rings = std::find_if(ring_sets().begin(), ring_sets().end(),
                                  [&](const std::vector<unsigned>& set) { return count_of(set) == count; });
  if (rings == ring_sets().end()) throw std::invalid_argument("cones: no set of " + std::to_string(count));
  std::vector<Cone> cones;
  double begin = 0.0; // sine squared at a ring's inner rim: the cosine-weighted share of what is inside
  for (const unsigned ring : *rings) {
    const double end = begin + static_cast<double>(ring) / count;
    const double inner = std::sqrt(1.0 - begin), outer = std::sqrt(std::max(0.0, 1.0 - end)); // cosines
    const double mean = 2.0 / 3.0 * (inner * inner * inner - outer * outer * outer) / (end - begin);
    const double z = ring == 1 ? 1.0 : mean, sine = std::sqrt(1.0 - z * z);
    const double half_angle_cosine = std::max(widest_cosine, 1.0 - (inner - outer) / ring);
    const double spread = 2.0 * std::sqrt(1.0 - half_angle_cosine * half_angle_cosine) / half_angle_cosine;
    for (unsigned k = 0; k < ring; ++k) {
      const double angle = 6.283185307179586 * (k + 0.5) / ring;
      cones.push_back({{static_cast<float>(sine * std::cos(angle)), static_cast<float>(sine * std::sin(angle)),
                        static_cast<float>(z)},
                       static_cast<float>(spread)});
    }
    begin = end;
  }
  return cones;
}

DeviceCones::DeviceCones(Session& session, View<Splat> points, View<std::uint32_t> places, const VoxelOptions& options,
                         unsigned cones)
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

void DeviceCones::apply(View<double> radiosity, LinearisationPoint, std::vector<double>& irradiance) {
  if (radiosity.size != 3 * places_.size()) throw std::invalid_argument("radiosity is not [points x 3]");
  irradiance.clear();
  if (places_.empty()) return;
  std::vector<cl_float4> light(pyramid_.points().size);
  for (std::size_t k = 0; k < places_.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c)
      light[places_[k]].s[c] = static_cast<float>(radiosity[3 * k + c]);
  pyramid_.inject(light);
  for_each_batch(EqualItems{places_.size()}, pace_, {}, [&](std::size_t first, std::size_t count) {
    const double seconds = session_.launch(trace_, LaunchShape::line(count, group), pyramid_.points(), place_buffer_,
                                           static_cast<cl_uint>(first), static_cast<cl_uint>(first + count), grid_,
                                           cones_, pyramid_.voxels(), irradiance_);
    trace_seconds_ += seconds;
    return seconds;
  });
  const std::vector<cl_float> found = session_.download(irradiance_, irradiance_.size);
  irradiance.assign(found.begin(), found.end());
}

} // namespace pointgi
