#pragma once
/// Small sound meshes: a tetrahedron in each kind of file.
#include "tests/support/ply_bytes.h"
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pointgi::test {

inline constexpr float tetrahedron[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline constexpr std::uint16_t tetrahedron_faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

inline std::string corner_text(const float (&corner)[3]) {
  return std::to_string(corner[0]) + " " + std::to_string(corner[1]) + " " + std::to_string(corner[2]);
}

inline std::string obj_seed() {
  std::string text = "mtllib input.mtl\no thing\n";
  for (const auto& corner : tetrahedron)
    text += "v " + corner_text(corner) + " 1 0.5 0\n";
  text += "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\ng first\nusemtl red\ns 1\nf 1/1/1 3/2/1 2/1/1\nf 1//2 2//2 4//2\n";
  return text + "f 1 4 3\nl 1 2\np 1\nf -3 -2 -1\nf 1 2 3 4\n";
}

inline std::string stl_text_seed() {
  std::string text = "solid thing\n";
  for (const auto& face : tetrahedron_faces) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const std::uint16_t corner : face)
      text += "vertex " + corner_text(tetrahedron[corner]) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid thing\n";
}

inline std::string stl_seed() {
  std::string bytes = std::string(80, ' ') + bytes_of<std::uint32_t>(4);
  for (const auto& face : tetrahedron_faces) {
    bytes += bytes_of(0.0f) + bytes_of(0.0f) + bytes_of(1.0f);
    for (const std::uint16_t corner : face)
      for (const float value : tetrahedron[corner])
        bytes += bytes_of(value);
    bytes += bytes_of<std::uint16_t>(0);
  }
  return bytes;
}

inline std::string off_seed() {
  std::string text = "OFF\n4 4 6\n";
  for (const auto& corner : tetrahedron)
    text += corner_text(corner) + "\n";
  for (const auto& face : tetrahedron_faces)
    text += "3 " + std::to_string(face[0]) + " " + std::to_string(face[1]) + " " + std::to_string(face[2]) + "\n";
  return text;
}

/// Positions, then indices.
inline std::string gltf_buffer() {
  std::string bytes;
  for (const auto& corner : tetrahedron)
    for (const float value : corner)
      bytes += bytes_of(value);
  for (const auto& face : tetrahedron_faces)
    for (const std::uint16_t corner : face)
      bytes += bytes_of(corner);
  return bytes;
}

inline std::string gltf_text(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,1]}],)"
         R"("materials":[{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]}}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0,"mode":4}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
         R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
         R"("buffers":[{"byteLength":72)" +
         uri + "}]}";
}

inline std::string base64(const std::string& bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) { // whole triples only: 72 bytes are
    const auto byte = [&](std::size_t k) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k]));
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (int shift = 18; shift >= 0; shift -= 6)
      text += digits[three >> shift & 63];
  }
  return text;
}

inline std::string gltf_seed() {
  return gltf_text(",\"uri\":\"data:application/octet-stream;base64," + base64(gltf_buffer()) + "\"");
}

inline std::string glb_seed() {
  std::string json = gltf_text("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltf_buffer();
  const auto word = [](std::size_t value) { return bytes_of(static_cast<std::uint32_t>(value)); };
  return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + buffer.size()) + word(json.size()) + "JSON" + json +
         word(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

/// By the extensions of their files, which are the targets' names.
inline std::vector<std::pair<std::string, std::string>> mesh_seeds() {
  return {{"obj", obj_seed()}, {"stl", stl_seed()},   {"stl", stl_text_seed()},
          {"off", off_seed()}, {"gltf", gltf_seed()}, {"glb", glb_seed()}};
}

} // namespace pointgi::test
