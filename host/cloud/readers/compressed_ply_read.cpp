#include "host/cloud/readers/gaussian_files.h"
#include "host/cloud/readers/gaussian_row.h"
#include "host/cloud/readers/ply_binary.h"
#include "host/cloud/readers/point_sink.h"
#include "host/run.h"
#include <limits>

namespace pointgi {

namespace {

constexpr std::uint64_t chunk_points = 256;

const std::array<const char*, 18> chunk_names{
    "min_x",       "min_y",       "min_z",       "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y", "min_scale_z",
    "max_scale_x", "max_scale_y", "max_scale_z", "min_r", "min_g", "min_b", "max_r",       "max_g",       "max_b"};
constexpr std::size_t position_bounds = 0, scale_bounds = 6, colour_bounds = 12;
using Chunk = std::array<double, chunk_names.size()>;

const std::array<const char*, 4> packed_names{"packed_position", "packed_rotation", "packed_scale", "packed_color"};
using Packed = std::array<std::uint32_t, packed_names.size()>;

const PlyElement* element_of(const PlyHeader& header, const char* name) {
  for (const PlyElement& element : header.elements)
    if (element.name == name) return &element;
  return nullptr;
}

/// For each property of the element its place among the names, or their number where it is none of them. The first
/// `required` names must be there.
template <std::size_t count>
std::vector<std::size_t> places_of(const PlyElement& element, const std::array<const char*, count>& names,
                                   std::size_t required, const std::string& file) {
  std::vector<std::size_t> places;
  std::array<bool, count> found{};
  for (const PlyProperty& property : element.properties) {
    const std::size_t place =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), property.name) - names.begin());
    places.push_back(property.is_list ? count : place);
    if (places.back() < count) found[place] = true;
  }
  for (std::size_t k = 0; k < required; ++k)
    if (!found[k])
      throw Error(ErrorKind::input, file + ": line " + std::to_string(element.line) + ": element " + element.name +
                                        " lacks the property " + names[k] +
                                        ", which compressed Gaussians have; save them as plain PLY");
  return places;
}

/// The values of a record by their places; `skipped` takes the others.
template <std::size_t count>
std::array<double, count> read_record(PlyBinaryBody& body, const PlyElement& element, std::uint64_t index,
                                      const std::vector<std::size_t>& places) {
  std::array<double, count> values{};
  body.begin_record(element, index);
  for (std::size_t p = 0; p < places.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (places[p] < count)
      values[places[p]] = body.scalar(property.type);
    else
      body.skip(property.type, property.is_list ? body.list_count(property) : 1);
  }
  body.end_record();
  return values;
}

/// The `bits` bits that end at bit `end`, as 0..1.
double share(std::uint32_t value, int end, int bits) {
  const std::uint32_t most = (1u << bits) - 1;
  return static_cast<double>(value >> end & most) / most;
}

/// 11, 10 and 11 bits between the bounds of a chunk: three smallest values, then three largest.
std::array<double, 3> between(std::uint32_t value, const Chunk& chunk, std::size_t bounds) {
  const std::array<double, 3> shares{share(value, 21, 11), share(value, 11, 10), share(value, 0, 11)};
  std::array<double, 3> result;
  for (std::size_t k = 0; k < 3; ++k)
    result[k] = chunk[bounds + k] + shares[k] * (chunk[bounds + 3 + k] - chunk[bounds + k]);
  return result;
}

GaussianRow unpack(const Packed& packed, const Chunk& chunk) {
  GaussianRow row;
  row.position = between(packed[0], chunk, position_bounds);
  row.log_scale = between(packed[2], chunk, scale_bounds);
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = chunk[colour_bounds + k];
    row.colour[k] = low + share(packed[3], 24 - 8 * static_cast<int>(k), 8) * (chunk[colour_bounds + 3 + k] - low);
  }
  row.opacity = share(packed[3], 0, 8);
  // Two bits for the largest of w x y z, then the others in their order, each from -sqrt(1/2) to sqrt(1/2).
  constexpr double root_two = 1.41421356237309505;
  const std::size_t largest = packed[1] >> 30;
  int end = 20;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == largest) continue;
    row.rotation[k] = (share(packed[1], end, 10) - 0.5) * root_two;
    end -= 10;
  }
  complete_quaternion(row.rotation, largest);
  return row;
}

void check(const PlyHeader& header, const PlyElement& vertex, const PlyElement& chunk, std::uint64_t file_size,
           const std::string& file) {
  const auto fail = [&](std::size_t line, const std::string& what) {
    throw Error(ErrorKind::input, file + ": line " + std::to_string(line) + ": " + what);
  };
  if (header.format == PlyFormat::ascii) fail(2, "compressed Gaussians as ascii, expected a binary format");
  if (vertex.count == 0) fail(vertex.line, "the cloud is empty (element vertex 0); expected one point or more");
  check_ply_counts(header, file_size, file);
  if (vertex.count > std::numeric_limits<std::uint32_t>::max())
    fail(vertex.line, std::to_string(vertex.count) + " points, expected at most 4294967295; split the file");
  if (chunk.count < (vertex.count - 1) / chunk_points + 1)
    fail(chunk.line, std::to_string(chunk.count) + " chunks for " + std::to_string(vertex.count) +
                         " points, expected one for every 256; the file is damaged");
  if (&chunk > &vertex) fail(chunk.line, "the chunks come after the points, expected them before");
}

} // namespace

PointCloud read_compressed_ply(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  const PlyElement* vertex = element_of(header, "vertex");
  const PlyElement* chunk = element_of(header, "chunk");
  if (vertex == nullptr || chunk == nullptr)
    throw Error(ErrorKind::input,
                path + ": line 1: expected elements chunk and vertex, which compressed Gaussians have");
  check(header, *vertex, *chunk, file.size(), path);
  const std::vector<std::size_t> chunk_places = places_of(*chunk, chunk_names, colour_bounds, path);
  const std::vector<std::size_t> packed_places = places_of(*vertex, packed_names, packed_names.size(), path);
  const auto bounds_of_colours = std::count_if(chunk_places.begin(), chunk_places.end(), [](std::size_t place) {
    return place >= colour_bounds && place < chunk_names.size();
  });
  for (std::size_t p = 0; p < packed_places.size(); ++p)
    if (packed_places[p] < packed_names.size() && is_float(vertex->properties[p].type))
      throw Error(ErrorKind::input, path + ": line " + std::to_string(vertex->line) + ": the property " +
                                        printable(vertex->properties[p].name) + " is a float, expected an integer");
  report.format = std::string("compressed Gaussians in PLY 1.0 ") + name_of(header.format);

  PlyBinaryBody body(header, file);
  std::vector<Chunk> chunks;
  PointSink sink(plan_gaussians(request, path, report), static_cast<std::size_t>(vertex->count), path);
  for (const PlyElement& element : header.elements) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % 65536 == 0) stop_if_asked();
      if (&element == chunk) {
        chunks.push_back(read_record<chunk_names.size()>(body, element, i, chunk_places));
        if (bounds_of_colours < 6) // older files have none: the colours are 0 to 1
          std::fill_n(std::fill_n(chunks.back().begin() + colour_bounds, 3, 0.0), 3, 1.0);
      } else if (&element == vertex) {
        const auto values = read_record<packed_names.size()>(body, element, i, packed_places);
        Packed packed{};
        for (std::size_t k = 0; k < packed.size(); ++k)
          packed[k] =
              static_cast<std::uint32_t>(static_cast<std::int64_t>(std::clamp(values[k], -2147483648.0, 4294967295.0)));
        sink.put(static_cast<std::size_t>(i), unpack(packed, chunks[i / chunk_points]).fields().data());
      }
    }
    if (&element == vertex) break; // what follows are harmonics
  }
  return sink.finish(report);
}

bool recognises_compressed_ply(const char* data, std::size_t size) {
  const std::string_view header(data, size);
  return header.substr(0, 3) == "ply" && header.find("packed_position") < header.find("end_header");
}

} // namespace pointgi
