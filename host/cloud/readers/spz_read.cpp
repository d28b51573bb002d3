#include "host/cloud/input_file.h"
#include "host/cloud/readers/gaussian_files.h"
#include "host/cloud/readers/gaussian_row.h"
#include "host/cloud/readers/gunzip.h"
#include "host/cloud/readers/point_sink.h"
#include "octree/parallel.h"
#include <cstring>

namespace pointgi {

namespace {

constexpr std::size_t header_bytes = 16;
constexpr std::uint32_t magic = 0x5053474e; // "NGSP"
constexpr std::size_t grain = 16384;

struct SpzHeader {
  std::uint32_t version = 0;
  std::uint32_t count = 0;
  unsigned harmonics = 0;     ///< degree
  unsigned fraction_bits = 0; ///< of the positions
};

std::uint32_t little_endian(const unsigned char* bytes, int count) {
  std::uint32_t value = 0;
  for (int k = 0; k < count; ++k)
    value |= static_cast<std::uint32_t>(bytes[k]) << (8 * k);
  return value;
}

double half_float(const unsigned char* bytes) {
  const std::uint32_t bits = little_endian(bytes, 2);
  const double sign = (bits & 0x8000) != 0 ? -1.0 : 1.0;
  const int exponent = static_cast<int>(bits >> 10 & 31);
  const double mantissa = static_cast<double>(bits & 1023);
  if (exponent == 31) return mantissa == 0.0 ? sign * HUGE_VAL : std::nan("");
  return sign * (exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024.0 + mantissa, exponent - 25));
}

/// Where the arrays of the unpacked data lie.
struct SpzArrays {
  explicit SpzArrays(const SpzHeader& header)
      : position_bytes(header.version == 1 ? 6 : 9), rotation_bytes(header.version < 3 ? 3 : 4) {
    const std::size_t n = header.count;
    opacity = n * position_bytes;
    colour = opacity + n;
    scale = colour + 3 * n;
    rotation = scale + 3 * n;
    harmonics = rotation + rotation_bytes * n;
    constexpr std::array<std::size_t, 5> terms{0, 3, 8, 15, 24}; // beside the constant one
    end = harmonics + 3 * terms[header.harmonics] * n;
  }
  std::size_t position_bytes, rotation_bytes;                   // of each Gaussian
  std::size_t opacity, colour, scale, rotation, harmonics, end; // offsets after the header
};

SpzHeader parse_header(const unsigned char* bytes, const std::string& path) {
  const auto fail = [&](int byte, const std::string& what) {
    throw Error(ErrorKind::input, path + ": byte " + std::to_string(byte) + " of the unpacked data: " + what);
  };
  if (little_endian(bytes, 4) != magic)
    fail(0, "expected the letters NGSP, with which SPZ begins; this is another file");
  SpzHeader header;
  header.version = little_endian(bytes + 4, 4);
  header.count = little_endian(bytes + 8, 4);
  header.harmonics = bytes[12];
  header.fraction_bits = bytes[13];
  if (header.version < 1 || header.version > 3)
    fail(4, "version " + std::to_string(header.version) + ", expected 1 to 3; save the Gaussians as PLY");
  if (header.count == 0) fail(8, "the file holds 0 Gaussians, expected 1 or more");
  if (header.harmonics > 4) fail(12, "harmonics of degree " + std::to_string(header.harmonics) + ", expected 0 to 4");
  if (header.fraction_bits > 24)
    fail(13, "positions with " + std::to_string(header.fraction_bits) + " fractional bits, expected 0 to 24");
  return header;
}

std::array<double, 3> position_at(const unsigned char* bytes, const SpzHeader& header) {
  std::array<double, 3> position;
  for (std::size_t k = 0; k < 3; ++k) {
    if (header.version == 1) {
      position[k] = half_float(bytes + 2 * k);
      continue;
    }
    const auto fixed = static_cast<std::int32_t>(little_endian(bytes + 3 * k, 3) << 8) / 256; // sign of 24 bits
    position[k] = std::ldexp(fixed, -static_cast<int>(header.fraction_bits));
  }
  return position;
}

/// Versions 1 and 2: x y z as bytes. Version 3: two bits for the largest of x y z w, and ten, a sign first, for each of
/// the others, the last of them lowest.
std::array<double, 4> rotation_at(const unsigned char* bytes, const SpzHeader& header) {
  std::array<double, 4> rotation{};
  if (header.version < 3) {
    for (std::size_t k = 0; k < 3; ++k)
      rotation[1 + k] = bytes[k] / 127.5 - 1.0;
    complete_quaternion(rotation, 0);
    return rotation;
  }
  constexpr double root_half = 0.70710678118654752;
  constexpr std::array<std::size_t, 4> place{1, 2, 3, 0}; // of x y z w in w x y z
  std::uint32_t bits = little_endian(bytes, 4);
  const std::size_t largest = bits >> 30;
  for (std::size_t k = 4; k-- > 0;) {
    if (k == largest) continue;
    const double size = root_half * (bits & 511) / 511.0;
    rotation[place[k]] = (bits & 512) != 0 ? -size : size;
    bits >>= 10;
  }
  complete_quaternion(rotation, place[largest]);
  return rotation;
}

GaussianRow row_at(const unsigned char* data, std::size_t i, const SpzHeader& header, const SpzArrays& arrays) {
  GaussianRow row;
  row.position = position_at(data + i * arrays.position_bytes, header);
  row.opacity = data[arrays.opacity + i] / 255.0;
  for (std::size_t k = 0; k < 3; ++k) {
    constexpr double harmonic_range = 0.15; // bytes hold f_dc * 0.15 + 0.5
    const double harmonic = (data[arrays.colour + 3 * i + k] / 255.0 - 0.5) / harmonic_range;
    row.colour[k] = 0.5 + GaussianRow::harmonic_constant * harmonic;
    row.log_scale[k] = data[arrays.scale + 3 * i + k] / 16.0 - 10.0;
  }
  row.rotation = rotation_at(data + arrays.rotation + i * arrays.rotation_bytes, header);
  return row;
}

} // namespace

PointCloud read_spz(const std::string& path, const ReadRequest& request, CloudReport& report) {
  report.usual_up = Eigen::Vector3d::UnitY(); // right, up, back: what the format's own programs turn scenes into
  const FileBytes bytes = read_whole_file(path);
  std::array<unsigned char, header_bytes> head;
  if (bytes.size >= head.size()) { // version 4 begins with its header, packed after it
    std::memcpy(head.data(), bytes.data.get(), head.size());
    if (little_endian(head.data(), 4) == magic) (void)parse_header(head.data(), path);
  }
  Gunzip unpacked(bytes.data.get(), bytes.size, path);
  unpacked.read(head.data(), head.size());
  const SpzHeader header = parse_header(head.data(), path);
  const SpzArrays arrays(header);
  unpacked.expect(arrays.end);
  // Memory is taken as data come: a count alone, if it is damaged, takes none.
  constexpr std::size_t piece = std::size_t{1} << 22;
  std::vector<unsigned char> data;
  while (data.size() < arrays.harmonics) {
    const std::size_t done = data.size();
    data.resize(std::min(arrays.harmonics, done + piece));
    unpacked.read(data.data() + done, data.size() - done);
  }
  unpacked.skip(arrays.end - arrays.harmonics);
  unpacked.finish();
  report.format = "SPZ version " + std::to_string(header.version);
  PointSink sink(plan_gaussians(request, path, report), header.count, path);
  parallel_ranges(header.count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      sink.put(i, row_at(data.data(), i, header, arrays).fields().data());
  });
  return sink.finish(report);
}

bool recognises_spz(const char* data, std::size_t size) {
  std::array<unsigned char, 4> first;
  return Gunzip::is_gzip(data, size) && Gunzip::peek(data, size, first.data(), first.size()) &&
         little_endian(first.data(), 4) == magic;
}

} // namespace pointgi
