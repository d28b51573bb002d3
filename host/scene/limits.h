#pragma once
/// Every limit that a scene file is held to, in one place, with the words an error uses for it.
#include <cstdint>

namespace pointgi::limits {

struct IntegerRange {
  long long low;
  long long high;
};

struct NumberRange {
  double low;
  double high;
  bool open_low;     ///< `low` itself is refused
  bool open_high;    ///< `high` itself is refused
  const char* words; ///< follows "a number " or "three numbers "
};

/// The file: a million lights are some 80 MB of text; what is far beyond is no scene (a cloud, most likely).
inline constexpr std::uintmax_t scene_bytes = 256u << 20;
/// Brackets and dotted keys. A scene needs 3 levels; the parser recurses once a level and the table tree is freed so.
inline constexpr unsigned nesting = 32;

inline constexpr IntegerRange version{1, 1};
inline constexpr IntegerRange image_side{1, 65536};
inline constexpr long long image_pixels = 1LL << 31;
inline constexpr IntegerRange spp{1, 65536};
inline constexpr IntegerRange seed{0, 4294967295};
inline constexpr IntegerRange max_depth{0, 256};
inline constexpr IntegerRange order{2, 6};
inline constexpr IntegerRange vmap_samples{1, 256};
inline constexpr IntegerRange point_samples{0, 65536};
inline constexpr IntegerRange vmap_rays{0, 1'000'000'000'000};
inline constexpr IntegerRange window{1, 1'000'000};
inline constexpr IntegerRange passes{0, 10'000};
inline constexpr IntegerRange directions{1, 65536};
inline constexpr IntegerRange light_samples = spp;
/// Of radiosity.method = "cones": finest voxels a side, and cones of a point. An occupancy grid has 128 at most.
inline constexpr int voxel_sides[] = {32, 64, 128, 256};
inline constexpr int cone_counts[] = {1, 6, 9, 16};
inline constexpr IntegerRange photons{0, 100'000'000};
inline constexpr IntegerRange gather_k{1, 1024};
inline constexpr IntegerRange leaf_capacity{1, 4096};
inline constexpr IntegerRange octree_depth{0, 21};
/// A quadratic has six terms, the farthest neighbour has no weight, and some lie on other faces.
inline constexpr IntegerRange mls_neighbours{9, 64};

// Lengths are squared in float on the device: 1e18 and 1e-18 leave areas of 1e36 and 1e-36, inside what float holds.
inline constexpr NumberRange coordinate{-1e18, 1e18, false, false, "from -1e18 to 1e18"};
inline constexpr NumberRange field_value{-1.7e308, 1.7e308, false, false, "that a double holds"};
inline constexpr NumberRange length{1e-18, 1e18, false, false, "> 0 (1e-18 to 1e18)"};
inline constexpr NumberRange scale{1e-18, 1e18, false, false, "> 0 (1e-18 to 1e18)"};
inline constexpr NumberRange angle{-1e6, 1e6, false, false, "of degrees from -1e6 to 1e6"};
inline constexpr NumberRange fov{0.0, 180.0, true, true, "of degrees > 0 and < 180"};
inline constexpr NumberRange exposure{-100.0, 100.0, false, false, "of stops from -100 to 100"};
inline constexpr NumberRange reflectance{0.0, 1.0, false, false, "from 0 to 1 (above 1 it would create energy)"};
inline constexpr NumberRange light{0.0, 1e30, false, false, "from 0 to 1e30 (light cannot be negative)"};
inline constexpr NumberRange latitude{-90.0, 90.0, false, false, "of degrees from -90 to 90, north positive"};
inline constexpr NumberRange longitude{-180.0, 180.0, false, false, "of degrees from -180 to 180, east positive"};
inline constexpr NumberRange absorption{0.0, 1e18, false, false, "from 0 to 1e18"};
inline constexpr NumberRange ior{0.0, 1e6, true, false, "> 0 and at most 1e6"};
inline constexpr NumberRange roughness{0.0, 1.0, false, false, "from 0 (smooth) to 1"};
inline constexpr NumberRange exponent{0.0, 1e6, false, false, "from 0 to 1e6"};
inline constexpr NumberRange tolerance{0.0, 1.0, true, true, "> 0 and < 1"};
inline constexpr NumberRange epsilon = tolerance;
inline constexpr NumberRange least_share{0.0, 1.0, false, true, "from 0 to below 1"};
/// Of a bare cloud, whose picture comes first and whose light is a guess: a scan of 440k points has a quarter of the
/// rays and 0.2 % less light between surfaces than with a scene's epsilon.
inline constexpr double bare_epsilon = 2e-2;
inline constexpr int bare_directions = 32;
/// Four times coarser than a scene's epsilon, but not coarser than this: beyond it pairs of clusters that exchange a
/// tenth of the light would not be divided, and what is drafted would look like another scene.
inline constexpr double coarsest_draft_epsilon = 0.1;

/// Sine of the angle below which two directions count as parallel: a camera's view and its up, a quad's edges.
inline constexpr double parallel_sine = 1e-6;
/// Two points this close, relative to the larger of their distances from the origin, are one point in doubles.
inline constexpr double same_point = 1e-14;

} // namespace pointgi::limits
