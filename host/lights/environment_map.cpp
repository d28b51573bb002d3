#include "host/lights/environment_map.h"
#include "host/cloud/input_file.h"
#include "host/image/hdr_reader.h"
#include "host/image/picture_writer.h"
#include "host/scene/shares.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

Vector3d radiance_of(const SkyTexel& texel) {
  return {texel.radiance[0], texel.radiance[1], texel.radiance[2]};
}

double luminance(const SkyTexel& texel) {
  return 0.2126 * static_cast<double>(texel.radiance[0]) + 0.7152 * static_cast<double>(texel.radiance[1]) +
         0.0722 * static_cast<double>(texel.radiance[2]);
}

/// 1 - cos(angle), exact for small angles.
double height_of(double angle) {
  return 2.0 * std::pow(std::sin(0.5 * angle), 2);
}

bool from_zenith(int row, int height) {
  return 2 * row < height;
}

SkyRow geometry_of_row(int row, int height, int width) {
  const int edge = from_zenith(row, height) ? row : height - 1 - row; // counted from the row's pole
  const double near = height_of(pi * edge / height), far = height_of(pi * (edge + 1) / height);
  SkyRow result{};
  result.from_pole = static_cast<float>(near);
  result.span = static_cast<float>(far - near);
  result.solid_angle = static_cast<float>(2.0 * pi / width * (far - near));
  return result;
}

/// One entry of a table of shares while it is made.
struct Share {
  double weight;
  float cumulative;
};

/// Where no entry has weight all have the same share: nothing draws from there, but every table is one.
void accumulate(std::vector<Share>& entries) {
  const bool empty =
      std::all_of(entries.begin(), entries.end(), [](const Share& entry) { return !(entry.weight > 0.0); });
  accumulate_shares(entries, [&](const Share& entry) { return empty ? 1.0 : entry.weight; });
}

/// Fills columns, rows and the texels' densities.
void make_tables(EnvironmentMap& map) {
  const auto width = static_cast<std::size_t>(map.width), height = static_cast<std::size_t>(map.height);
  map.columns.resize(width * height);
  map.rows.resize(height);
  std::vector<Share> of_rows(height);
  constexpr std::size_t rows_each = 16;
  parallel_ranges(height, rows_each, [&](std::size_t begin, std::size_t end) {
    std::vector<Share> row(width);
    for (std::size_t y = begin; y < end; ++y) {
      map.rows[y] = geometry_of_row(static_cast<int>(y), map.height, map.width);
      double sum = 0.0;
      for (std::size_t x = 0; x < width; ++x) {
        row[x].weight = luminance(map.texels[y * width + x]);
        sum += row[x].weight;
      }
      accumulate(row);
      for (std::size_t x = 0; x < width; ++x)
        map.columns[y * width + x] = row[x].cumulative;
      of_rows[y].weight = sum * static_cast<double>(map.rows[y].solid_angle);
    }
  });
  accumulate(of_rows);
  const auto share = [](float cumulative, const float* before) {
    return static_cast<double>(cumulative) - (before != nullptr ? static_cast<double>(*before) : 0.0);
  };
  parallel_ranges(height, rows_each, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      map.rows[y].cumulative = of_rows[y].cumulative;
      const double of_row = share(of_rows[y].cumulative, y > 0 ? &of_rows[y - 1].cumulative : nullptr);
      const float* column = &map.columns[y * width];
      for (std::size_t x = 0; x < width; ++x)
        map.texels[y * width + x].density = static_cast<float>(
            of_row * share(column[x], x > 0 ? &column[x - 1] : nullptr) / static_cast<double>(map.rows[y].solid_angle));
    }
  });
}

/// Counts the pixels with a value that is no radiance and takes those values as 0.
std::size_t take_radiances(const RgbImage& image, double scale, std::vector<SkyTexel>& texels) {
  std::size_t wrong = 0;
  texels.resize(image.pixels());
  for (std::size_t i = 0; i < texels.size(); ++i) {
    bool is_wrong = false;
    for (std::size_t k = 0; k < 3; ++k) {
      float value = static_cast<float>(static_cast<double>(image.rgb[3 * i + k]) * scale);
      if (!(value >= 0.0f) || !std::isfinite(value)) {
        is_wrong = true;
        value = 0.0f;
      }
      texels[i].radiance[k] = value;
    }
    wrong += is_wrong;
  }
  return wrong;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(ErrorKind::input, path + ": " + what);
}

RgbImage read_exr_image(const std::string& path) {
  const Picture picture = read_exr(path);
  if (picture.window.x0 != 0 || picture.window.y0 != 0 || picture.width != picture.full_width ||
      picture.height != picture.full_height)
    refuse(path, "its data window is " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                     " of an image of " + std::to_string(picture.full_width) + " x " +
                     std::to_string(picture.full_height) +
                     " pixels, expected all of a latitude-longitude map; export it without a crop");
  RgbImage image;
  image.width = picture.width;
  image.height = picture.height;
  const std::size_t pixels = image.pixels();
  if (pixels > most_map_pixels)
    refuse(path, "the map has " + std::to_string(pixels) + " pixels, expected " + std::to_string(most_map_pixels) +
                     " at most; scale it down");
  image.rgb.resize(3 * pixels);
  const char* names[3] = {"R", "G", "B"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto channel = picture.channels.find(names[k]);
    if (channel == picture.channels.end())
      refuse(path, std::string("it has no channel ") + names[k] + ", expected R, G and B; export it as RGB");
    for (std::size_t i = 0; i < pixels; ++i)
      image.rgb[3 * i + k] = channel->second[i];
  }
  return image;
}

/// Angle with the zenith and azimuth of a texel's corner (x, y), columns and rows as they are counted.
struct Angles {
  double zenith, azimuth;
};

Angles angles_at(const EnvironmentMap& map, double x, double y) {
  return {pi * y / map.height, 2.0 * pi * (x / map.width - 0.5)};
}

Vector3d direction_at(const EnvironmentMap& map, const Angles& at) {
  return std::sin(at.zenith) * (std::sin(at.azimuth) * map.frame.right + std::cos(at.azimuth) * map.frame.forward) +
         std::cos(at.zenith) * map.frame.up;
}

/// Integral of the direction over the cell between two corners, in closed form.
Vector3d direction_integral(const EnvironmentMap& map, const Angles& a, const Angles& b) {
  const auto sine2 = [](double t) { return 0.5 * (t - std::sin(t) * std::cos(t)); }; // of sin²
  const double flat = sine2(b.zenith) - sine2(a.zenith);
  const double upright = 0.5 * (std::pow(std::sin(b.zenith), 2) - std::pow(std::sin(a.zenith), 2));
  return flat * ((std::cos(a.azimuth) - std::cos(b.azimuth)) * map.frame.right +
                 (std::sin(b.azimuth) - std::sin(a.azimuth)) * map.frame.forward) +
         upright * (b.azimuth - a.azimuth) * map.frame.up;
}

double solid_angle_between(const Angles& a, const Angles& b) {
  return (b.azimuth - a.azimuth) * 2.0 * std::sin(0.5 * (a.zenith + b.zenith)) * std::sin(0.5 * (b.zenith - a.zenith));
}

/// Integral of max(0, direction . normal) over one texel.
double cosine_integral(const EnvironmentMap& map, int x, int y, const Vector3d& normal) {
  const Angles a = angles_at(map, x, y), b = angles_at(map, x + 1, y + 1);
  const double middle = direction_at(map, angles_at(map, x + 0.5, y + 0.5)).dot(normal);
  // No direction of the texel is farther from its middle than this, nor is the cosine.
  const double reach = 0.5 * (b.zenith - a.zenith + b.azimuth - a.azimuth);
  if (middle > reach) return direction_integral(map, a, b).dot(normal);
  if (middle < -reach) return 0.0;
  constexpr int parts = 16;
  double sum = 0.0;
  for (int j = 0; j < parts; ++j)
    for (int i = 0; i < parts; ++i) {
      const Angles low = angles_at(map, x + i / double{parts}, y + j / double{parts});
      const Angles high = angles_at(map, x + (i + 1) / double{parts}, y + (j + 1) / double{parts});
      const Angles centre{0.5 * (low.zenith + high.zenith), 0.5 * (low.azimuth + high.azimuth)};
      sum += std::fmax(0.0, direction_at(map, centre).dot(normal)) * solid_angle_between(low, high);
    }
  return sum;
}

} // namespace

EnvironmentMap make_environment_map(const RgbImage& image, const SkyFrame& frame, double scale,
                                    const std::string& name) {
  EnvironmentMap map;
  map.width = image.width;
  map.height = image.height;
  map.frame = frame;
  const std::size_t wrong = take_radiances(image, scale, map.texels);
  if (wrong > 0)
    map.warnings.push_back(name + ": " + std::to_string(wrong) + " of " + std::to_string(map.texels.size()) +
                           " pixels have values that are negative or not finite; these values are taken as 0");
  make_tables(map);
  const Vector3d first = radiance_of(map.texels.front());
  const auto is_first = [&](const SkyTexel& texel) { return radiance_of(texel) == first; };
  if (std::all_of(map.texels.begin(), map.texels.end(), is_first)) map.constant = first;
  map.is_black = map.constant && *map.constant == Vector3d::Zero();
  if (!map.constant && map.width != 2 * map.height)
    map.warnings.push_back(name + ": the map is " + std::to_string(map.width) + " x " + std::to_string(map.height) +
                           " pixels; a latitude-longitude map is twice as wide as high, this one is stretched to one");
  return map;
}

EnvironmentMap load_environment_map(const std::string& path, const SkyFrame& frame, double scale) {
  if (has_extension(path, ".hdr") || has_extension(path, ".pic")) {
    const FileBytes bytes = read_whole_file(path);
    return make_environment_map(decode_hdr(std::string_view(bytes.data.get(), bytes.size), path, most_map_pixels),
                                frame, scale, path);
  }
  if (has_extension(path, ".exr")) return make_environment_map(read_exr_image(path), frame, scale, path);
  refuse(path, "an environment map must be a .hdr or .exr file; convert it");
}

std::vector<SkyTexel> device_texels(const EnvironmentMap& map, double scale) {
  std::vector<SkyTexel> texels = map.texels;
  for (SkyTexel& texel : texels)
    for (float& value : texel.radiance)
      value = static_cast<float>(static_cast<double>(value) / scale);
  return texels;
}

SkyMap device_sky_map(const EnvironmentMap& map) {
  SkyMap result{};
  for (int k = 0; k < 3; ++k) {
    result.right[k] = static_cast<float>(map.frame.right[k]);
    result.forward[k] = static_cast<float>(map.frame.forward[k]);
    result.up[k] = static_cast<float>(map.frame.up[k]);
  }
  result.width = static_cast<pg_uint>(map.width);
  result.height = static_cast<pg_uint>(map.height);
  return result;
}

std::size_t texel_towards(const EnvironmentMap& map, const Vector3d& direction) {
  const double x = direction.dot(map.frame.right), y = direction.dot(map.frame.forward),
               z = direction.dot(map.frame.up);
  const double column = (std::atan2(x, y) / (2.0 * pi) + 0.5) * map.width;
  const double row = std::atan2(std::hypot(x, y), z) / pi * map.height;
  const auto clamped = [](double value, int size) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(value), 0, size - 1));
  };
  return clamped(row, map.height) * static_cast<std::size_t>(map.width) + clamped(column, map.width);
}

SkySample sample_map(const EnvironmentMap& map, const std::array<double, 4>& u) {
  const auto row = std::upper_bound(map.rows.begin(), map.rows.end(), u[0], [](double value, const SkyRow& r) {
    return value < static_cast<double>(r.cumulative);
  });
  const auto y = static_cast<std::size_t>(row - map.rows.begin());
  const auto first = map.columns.begin() + static_cast<std::ptrdiff_t>(y * static_cast<std::size_t>(map.width));
  const auto column = std::upper_bound(first, first + map.width, u[1],
                                       [](double value, float share) { return value < static_cast<double>(share); });
  const auto x = static_cast<std::size_t>(column - first);
  const double height = static_cast<double>(row->from_pole) + u[3] * static_cast<double>(row->span);
  const double cosine = from_zenith(static_cast<int>(y), map.height) ? 1.0 - height : height - 1.0;
  const double sine = std::sqrt(std::fmax(0.0, height * (2.0 - height)));
  const double azimuth = 2.0 * pi * ((static_cast<double>(x) + u[2]) / map.width - 0.5);
  return {sine * (std::sin(azimuth) * map.frame.right + std::cos(azimuth) * map.frame.forward) + cosine * map.frame.up,
          y * static_cast<std::size_t>(map.width) + x};
}

double largest_radiance(const EnvironmentMap& map) {
  float largest = 0.0f;
  for (const SkyTexel& texel : map.texels)
    largest = std::max({largest, texel.radiance[0], texel.radiance[1], texel.radiance[2]});
  return static_cast<double>(largest);
}

Vector3d mean_radiance(const EnvironmentMap& map) {
  Vector3d sum = Vector3d::Zero();
  for (int y = 0; y < map.height; ++y) {
    Vector3d row = Vector3d::Zero();
    for (int x = 0; x < map.width; ++x)
      row += radiance_of(
          map.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x)]);
    sum += row * solid_angle_between(angles_at(map, 0, y), angles_at(map, 1, y + 1));
  }
  return sum / (4.0 * pi);
}

Vector3d irradiance(const EnvironmentMap& map, const Vector3d& normal) {
  Vector3d sum = Vector3d::Zero();
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
      if (map.texels[i].density > 0.0f) sum += radiance_of(map.texels[i]) * cosine_integral(map, x, y, normal);
    }
  return sum;
}

} // namespace pointgi
