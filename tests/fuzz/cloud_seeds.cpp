#include "tests/fuzz/cloud_seeds.h"
#include "tests/support/e57_bytes.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/ply_bytes.h"
#include <cmath>
#include <cstdint>

namespace pointgi::test {

namespace {

constexpr int points = 6;

/// Coordinate `axis` of point `i`: an octahedron.
float at(int i, int axis) {
  return i / 2 == axis ? (i % 2 == 0 ? 1.0f : -1.0f) : 0.0f;
}

template <class Value>
std::string little(Value value) {
  return bytes_of(value, false);
}

/// The places of the numbers that stand behind each of the texts.
std::vector<CountPlace> digits_behind(const std::string& bytes, const std::vector<std::string>& texts) {
  std::vector<CountPlace> places;
  for (const std::string& text : texts) {
    const std::size_t begin = bytes.find(text) + text.size();
    const std::size_t end = bytes.find_first_not_of("0123456789", begin);
    places.push_back({begin, std::min(end, bytes.size()) - begin, true});
  }
  return places;
}

/// Gaussians as plain PLY, with scanner positions.
CloudSeed gaussian_ply() {
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment pointgi up z\nelement station 2\nproperty double "
                      "x\nproperty double y\nproperty double z\nelement vertex 6\nproperty ushort station\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "f_rest_0", "opacity",
                           "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    bytes += std::string("property float ") + name + "\n";
  bytes += "end_header\n";
  for (int i = 0; i < 6; ++i)
    bytes += little(static_cast<double>(i));
  for (int i = 0; i < points; ++i) {
    bytes += little(static_cast<std::uint16_t>(i % 2));
    for (const float value : {at(i, 0), at(i, 1), at(i, 2), 0.0f, 0.0f, 0.0f, 0.5f, 0.1f, -0.2f, 0.0f, 3.0f, -2.0f,
                              -2.0f, -5.0f, 1.0f, 0.0f, 0.0f, 0.5f})
      bytes += little(value);
  }
  return {"PLY", ".ply", bytes, points, "end_header", digits_behind(bytes, {"element station ", "element vertex "})};
}

/// Packed colours, colours of faces.
CloudSeed face_ply() {
  std::string bytes = "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\nproperty double "
                      "z\nproperty float rgb\nproperty float intensity\nelement face 2\nproperty list uchar int "
                      "vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  for (int i = 0; i < points; ++i)
    bytes += std::to_string(at(i, 0)) + " " + std::to_string(at(i, 1)) + " " + std::to_string(at(i, 2)) +
             " 4.2108e+06 0.5\n";
  bytes += "3 0 2 4 255 0 0\n4 1 2 3 4 0 9 255\n";
  return {"PLY", ".ply", bytes, points, "end_header", digits_behind(bytes, {"element vertex ", "element face "})};
}

CloudSeed compressed_ply() {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement chunk 1\n";
  for (const char* name : {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y",
                           "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"})
    bytes += std::string("property float ") + name + "\n";
  bytes += "element vertex 6\n";
  for (const char* name : {"packed_position", "packed_rotation", "packed_scale", "packed_color"})
    bytes += std::string("property uint ") + name + "\n";
  bytes += "end_header\n";
  for (int i = 0; i < 12; ++i)
    bytes += little(i < 3 ? -1.0f : i < 6 ? 1.0f : i < 9 ? -6.0f : -2.0f);
  for (int i = 0; i < points; ++i)
    for (const std::uint32_t value :
         {0x9e3779b9u * static_cast<std::uint32_t>(i), 0x20080200u, 0x80100400u, 0xff8040ffu})
      bytes += little(value);
  return {"compressed PLY of Gaussians",
          ".compressed.ply",
          bytes,
          points,
          "end_header",
          digits_behind(bytes, {"element chunk ", "element vertex "})};
}

/// LAS 1.`minor`; `extra` extra bytes that a record LASF_Spec 4 describes as one float.
CloudSeed las(int minor, int format, bool extra) {
  constexpr std::size_t record_bytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const std::size_t header_bytes = minor == 4 ? 375 : minor == 3 ? 235 : 227;
  const std::size_t record = record_bytes[format] + (extra ? 4 : 0);
  const std::size_t vlr = extra ? 54 + 192 : 0;
  std::string bytes(header_bytes, '\0');
  const auto put = [&](std::size_t at_byte, const std::string& value) { bytes.replace(at_byte, value.size(), value); };
  put(0, "LASF");
  put(24, std::string{1, static_cast<char>(minor)});
  put(94, little(static_cast<std::uint16_t>(header_bytes)) + little(static_cast<std::uint32_t>(header_bytes + vlr)) +
              little<std::uint32_t>(extra ? 1 : 0));
  put(104, std::string(1, static_cast<char>(format)) + little(static_cast<std::uint16_t>(record)) +
               little<std::uint32_t>(format < 6 ? points : 0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(131 + 8 * axis, little(0.001));
    put(155 + 8 * axis, little(1000.0));
  }
  if (minor == 4) put(247, little<std::uint64_t>(points));
  if (extra) {
    std::string entry(192, '\0');
    entry[2] = 9; // float
    entry.replace(4, 4, "tree");
    bytes += std::string(2, '\0') + std::string("LASF_Spec\0\0\0\0\0\0\0", 16) + little<std::uint16_t>(4) +
             little<std::uint16_t>(192) + std::string(32, '\0') + entry;
  }
  for (int i = 0; i < points; ++i) {
    std::string point;
    for (int axis = 0; axis < 3; ++axis)
      point += little(static_cast<std::int32_t>(1000 * at(i, axis)));
    point.resize(record_bytes[format], static_cast<char>(17 + i));
    bytes += point + (extra ? little(0.5f) : "");
  }
  std::vector<CountPlace> counts{{96, 4, false}, {100, 4, false}, {105, 2, false}, {107, 4, false}};
  if (minor == 4) counts.insert(counts.end(), {{235, 8, false}, {243, 4, false}, {247, 8, false}});
  if (extra) counts.push_back({header_bytes + 20, 2, false});
  return {"LAS", ".las", bytes, points, "", counts};
}

/// `data`: what stands behind DATA.
CloudSeed pcd(const std::string& data) {
  std::string bytes = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb normal label\nSIZE 4 4 4 4 4 2\nTYPE F F F F F U\n"
                      "COUNT 1 1 1 1 3 1\nWIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 5 1 0 0 0\nPOINTS 6\nDATA " +
                      data + "\n";
  std::vector<CountPlace> counts = digits_behind(bytes, {"COUNT 1 1 1 1 ", "WIDTH ", "HEIGHT ", "POINTS "});
  std::string rows, columns[8];
  for (int i = 0; i < points; ++i) {
    std::vector<std::string> values{
        little(at(i, 0)), little(at(i, 1)), little(at(i, 2)), little<std::uint32_t>(0xff8040),
        little(0.0f),     little(0.6f),     little(0.8f),     little<std::uint16_t>(static_cast<std::uint16_t>(i))};
    for (std::size_t k = 0; k < values.size(); ++k)
      rows += values[k];
    for (std::size_t k = 0; k < 4; ++k)
      columns[k] += values[k];
    columns[4] += values[4] + values[5] + values[6];
    columns[5] += values[7];
  }
  if (data == "binary") {
    bytes += rows;
  } else if (data == "binary_compressed") {
    std::string all;
    for (const std::string& column : columns)
      all += column;
    std::string packed; // LZF: runs of at most 32 bytes as they are
    for (std::size_t begin = 0; begin < all.size(); begin += 32) {
      const std::string run = all.substr(begin, 32);
      packed += static_cast<char>(run.size() - 1);
      packed += run;
    }
    // And one reference back: the last eight bytes again, six of them from eight bytes before.
    counts.push_back({bytes.size(), 4, false});
    counts.push_back({bytes.size() + 4, 4, false});
    bytes +=
        little(static_cast<std::uint32_t>(packed.size())) + little(static_cast<std::uint32_t>(all.size())) + packed;
  } else {
    for (int i = 0; i < points; ++i)
      bytes += std::to_string(at(i, 0)) + " " + std::to_string(at(i, 1)) + " nan 4.2108e+06 0 0.6 0.8 7\n";
  }
  CloudSeed seed{"PCD", ".pcd", bytes, points, "DATA", counts};
  if (data == "binary_compressed") seed.expansion = 264; // three bytes of LZF stand for 264 at most
  return seed;
}

CloudSeed ptx() {
  const std::string header = "2\n3\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n";
  std::string bytes;
  for (int grid = 0; grid < 2; ++grid) {
    bytes += header;
    for (int i = 0; i < points; ++i)
      bytes += std::to_string(at(i, 0)) + " " + std::to_string(at(i, 1)) + " " + std::to_string(at(i, 2)) +
               " 0.5 255 128 0\n";
  }
  return {"PTX", ".ptx", bytes, 2 * points, "", {{0, 1, true}, {2, 1, true}}};
}

/// A line a point: what stands before and behind its coordinates, and between the values.
CloudSeed table(const std::string& format, const std::string& extension, const std::string& head,
                const std::string& before, const std::string& behind, char separator) {
  std::string bytes = head;
  for (int i = 0; i < points; ++i) {
    bytes += before;
    for (int axis = 0; axis < 3; ++axis)
      bytes += (axis > 0 ? std::string(1, separator) : "") + std::to_string(at(i, axis));
    bytes += behind + "\n";
  }
  std::vector<CountPlace> counts;
  if (extension == ".pts") counts.push_back({0, 1, true});
  return {format, extension, bytes, points, "", counts};
}

CloudSeed splat() {
  std::string bytes;
  for (int i = 0; i < points; ++i) {
    for (const float value : {at(i, 0), at(i, 1), at(i, 2), 0.1f, 0.1f, 0.01f})
      bytes += little(value);
    bytes += std::string("\xff\x80\x40\xff\xff\x80\x80\xa0", 8);
  }
  return {"splat", ".splat", bytes, points, "", {}};
}

/// gzip around one block that is stored as it is.
std::string gzip_stored(const std::string& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit)
      crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  const auto size = static_cast<std::uint16_t>(bytes.size());
  return std::string("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10) + "\x01" + little(size) +
         little(static_cast<std::uint16_t>(~size)) + bytes + little(~crc) +
         little(static_cast<std::uint32_t>(bytes.size()));
}

CloudSeed spz(std::uint32_t version) {
  std::string bytes = little<std::uint32_t>(0x5053474e) + little(version) + little<std::uint32_t>(points) +
                      std::string("\x01\x0c\x00\x00", 4); // harmonics of degree 1, 12 bits of fraction
  for (int i = 0; i < points; ++i)
    for (int axis = 0; axis < 3; ++axis)
      bytes += little(static_cast<std::int32_t>(4096 * at(i, axis))).substr(0, 3);
  bytes += std::string(points, '\xff') + std::string(3 * points, '\x80') + std::string(3 * points, '\x50');
  bytes += std::string((version < 3 ? 3 : 4) * points, '\x60') + std::string(9 * points, '\x80');
  return {"SPZ", ".spz", bytes, points, "", {{8, 4, false}, {12, 1, false}, {13, 1, false}}, 1032, gzip_stored};
}

CloudSeed e57() {
  const std::string bytes = e57_two_stations();
  std::vector<CountPlace> counts = digits_behind(bytes, {"recordCount=\"", "fileOffset=\"", "maximum=\""});
  // Lengths of the file, the description and the first section; of a packet and its streams.
  counts.insert(counts.end(), {{16, 8, false},
                               {24, 8, false},
                               {32, 8, false},
                               {40, 8, false},
                               {56, 8, false},
                               {64, 8, false},
                               {82, 2, false},
                               {84, 2, false},
                               {86, 2, false}});
  return {"E57", ".e57", bytes, 3, "", counts, 8, e57_pages}; // a record takes a bit at least
}

CloudSeed laz(const LazSample& sample) {
  const std::string bytes = laz_file(sample, true);
  const std::size_t header = sample.format < 6 ? 227 : 375, description = header + 54;
  const std::size_t table = bytes.size() - from_hex(sample.table).size();
  const std::size_t chunk = table - from_hex(sample.chunk).size();
  std::vector<CountPlace> counts{{96, 4, false},
                                 {100, 4, false},
                                 {105, 2, false},
                                 {107, 4, false},
                                 {description + 12, 4, false},
                                 {description + 32, 2, false},
                                 {header + 20, 2, false},
                                 {chunk - 8, 8, false},
                                 {table + 4, 4, false}};
  if (sample.format >= 6) { // a chunk's points, and the bytes of its layers
    counts.push_back({247, 8, false});
    const std::size_t record = laz_record(sample.format, 0).size();
    for (std::size_t layer = 0; layer < 14; ++layer)
      counts.push_back({chunk + record + 4 * layer, 4, false});
  }
  return {"LAZ", ".laz", bytes, laz_points, "", counts, 200}; // points that a byte is believed to hold
}

} // namespace

std::vector<CloudSeed> cloud_seeds() {
  std::vector<CloudSeed> seeds{gaussian_ply(), face_ply(), compressed_ply()};
  for (const int format : {0, 1, 2, 3})
    seeds.push_back(las(2, format, format == 3));
  for (const int format : {4, 5})
    seeds.push_back(las(3, format, false));
  for (const int format : {6, 7, 8, 9, 10})
    seeds.push_back(las(4, format, format == 8));
  for (const LazSample& sample : laz_samples())
    seeds.push_back(laz(sample));
  for (const char* data : {"ascii", "binary", "binary_compressed"})
    seeds.push_back(pcd(data));
  seeds.push_back(ptx());
  seeds.push_back(table("text", ".pts", "6\n", "", " -812 255 128 0", ' '));
  seeds.push_back(table("text", ".xyz", "# a comment\n", "", " 0.5 255 128 0 0 0.6 0.8", ' '));
  seeds.push_back(table("text", ".csv", "X;Y;Z;R;G;B;label\n", "", ";255;128;0;7", ';'));
  seeds.push_back(table("text", ".txt", "# 3D point list\n", "7 ", " 255 128 0 0.25 1 5 2 6", ' '));
  seeds.push_back(e57());
  seeds.push_back(splat());
  for (const std::uint32_t version : {2u, 3u})
    seeds.push_back(spz(version));
  return seeds;
}

} // namespace pointgi::test
