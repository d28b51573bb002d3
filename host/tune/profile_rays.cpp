#include "host/tune/profile_rays.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <random>

namespace pointgi {

namespace {

/// The window's pixels in the order in which a renderer takes them: tiles of 16x16, in them the squares of a packet.
template <typename Take>
void for_pixels(const PixelWindow& window, const Take& take) {
  constexpr int tile = 16, columns = PACKET_COLUMNS, square = PACKET_COLUMNS * PACKET_ROWS;
  for (int y = window.y0; y < window.y1; y += tile)
    for (int x = window.x0; x < window.x1; x += tile)
      for (int k = 0; k < tile * tile; ++k) {
        const int px = x + k / square % (tile / columns) * columns + k % columns,
                  py = y + k / (tile * PACKET_ROWS) * PACKET_ROWS + k % square / columns;
        if (px < window.x1 && py < window.y1) take(px, py);
      }
}

} // namespace

std::vector<RayQuery> eye_rays(const Camera& camera, const PixelWindow& window) {
  std::vector<RayQuery> rays;
  rays.reserve(static_cast<std::size_t>(window.x1 - window.x0) * (window.y1 - window.y0) * GRID_RAYS);
  for_pixels(window, [&](int px, int py) {
    for (int s = 0; s < GRID_RAYS; ++s) {
      const float x = static_cast<float>(px) + (static_cast<float>(s % GRID_X) + 0.5f) / GRID_X,
                  y = static_cast<float>(py) + (static_cast<float>(s / GRID_X) + 0.5f) / GRID_Y;
      Eigen::Vector3f d;
      for (int a = 0; a < 3; ++a)
        d[a] = camera.corner[a] + x * camera.step_x[a] + y * camera.step_y[a];
      d.normalize();
      RayQuery ray{};
      std::copy_n(camera.origin, 3, ray.origin);
      std::copy_n(d.data(), 3, ray.direction);
      ray.t_max = 1e6f; // beyond any camera that is worth profiling
      rays.push_back(ray);
    }
  });
  while (rays.size() % PACKET_RAYS != 0)
    rays.push_back(RayQuery(rays.back()));
  return rays;
}

std::vector<RayQuery> bounced_rays(View<Splat> splats, std::size_t count, unsigned seed) {
  std::mt19937 g(seed); // its numbers are the same everywhere; the distributions of the library are not
  const auto uniform = [&] { return (static_cast<float>(g() >> 8) + 0.5f) * 0x1p-24f; };
  std::vector<RayQuery> rays(count);
  for (RayQuery& ray : rays) {
    const Splat& s = splats[g() % splats.size];
    const Eigen::Vector3f normal(s.normal[0], s.normal[1], s.normal[2]);
    const float z = 2.0f * uniform() - 1.0f, angle = 6.2831853f * uniform(), r = std::sqrt(1.0f - z * z);
    // A point of the unit sphere upon the normal's end is cosine-distributed; 0.999 keeps it off the opposite pole.
    const Eigen::Vector3f d =
        (normal + 0.999f * Eigen::Vector3f(r * std::cos(angle), r * std::sin(angle), z)).normalized();
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = s.position[a] + 0.5f * s.radius * normal[a];
      ray.direction[a] = d[a];
    }
    ray.t_min = s.radius; // past the splat's own surface
    ray.t_max = 8.0f;
  }
  return rays;
}

std::vector<SegmentQuery> segments_between(std::size_t splats, std::size_t count, unsigned seed) {
  std::mt19937 g(seed);
  std::vector<SegmentQuery> segments(count);
  for (SegmentQuery& segment : segments) {
    segment.from = static_cast<pg_uint>(g() % splats);
    segment.to = static_cast<pg_uint>(g() % splats);
  }
  return segments;
}

PixelWindow middle_window(int width, int height, std::size_t pixels) {
  const int wanted = static_cast<int>(std::min<std::size_t>(pixels, 1u << 30));
  const int rows = std::clamp(wanted / width, std::min(4, height), height);
  const int columns = std::clamp(wanted / rows, 1, width);
  const int x0 = (width - columns) / 2, y0 = (height - rows) / 2;
  return {x0, x0 + columns, y0, y0 + rows};
}

} // namespace pointgi
