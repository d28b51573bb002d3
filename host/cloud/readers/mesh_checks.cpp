#include "host/cloud/readers/mesh_checks.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/record_values.h"
#include "host/trial.h"
#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/mesh.h>
#include <charconv>

namespace pointgi {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(ErrorKind::input, path + ": cannot be read as a mesh: " + what + "; the file is damaged, save it again");
}

/// Magic, version and length of the file, 4 bytes each, and before each chunk its length and its kind.
void check_glb(const InputFile& file) {
  constexpr std::uint64_t header = 12, chunk_header = 8;
  char magic[4] = {};
  file.read(0, magic, std::min<std::uint64_t>(file.size(), sizeof magic));
  if (std::string_view(magic, sizeof magic) != "glTF") {
    // Or Assimp tries every format that it knows, and reads past the end of such files.
    if (has_extension(file.path(), ".glb"))
      refuse(file.path(), "it begins with " + quoted_bytes({magic, sizeof magic}) + ", expected glTF");
    return;
  }
  if (file.size() < header) return;
  for (std::uint64_t at = header; at + chunk_header <= file.size();) {
    char bytes[4];
    file.read(at, bytes, sizeof bytes);
    const auto length = little_endian<std::uint32_t>(bytes);
    if (length > file.size() - at - chunk_header)
      refuse(file.path(), "byte " + std::to_string(at) + " promises a chunk of " + std::to_string(length) +
                              " bytes, and the file ends before");
    at += chunk_header + length;
  }
}

/// Whether a primitive may be a line loop, a line strip or a triangle fan; keys with escapes may be any.
bool has_lines_or_fans(std::string_view text) {
  if (text.find("\\u") != std::string_view::npos) return true;
  constexpr std::string_view key = "\"mode\"";
  for (std::size_t at = 0; (at = text.find(key, at)) != std::string_view::npos;) {
    at = text.find_first_not_of(" \t\r\n:", at + key.size());
    if (at == std::string_view::npos || text[at] == '2' || text[at] == '3' || text[at] == '6') return true;
  }
  return false;
}

/// After check_glb(): the description, which is all of a text file and the first chunk of a binary one.
std::string gltf_text(const InputFile& file) {
  constexpr std::uint64_t length_at = 12, text_at = 20;
  std::uint64_t from = 0, size = file.size();
  char start[text_at];
  if (size >= text_at) {
    file.read(0, start, sizeof start);
    if (std::string_view(start, 4) == "glTF") from = text_at, size = little_endian<std::uint32_t>(start + length_at);
  }
  std::string text(size, '\0');
  file.read(from, text.data(), size);
  return text;
}

void check_gltf(const InputFile& file) {
  if (!has_lines_or_fans(gltf_text(file))) return;
  const Trial trial = try_in_child([&] {
    Assimp::Importer().ReadFile(file.path(), 0);
    return std::string();
  });
  if (trial.status != 0) refuse(file.path(), "the library that reads it crashes, at a line or a fan of triangles");
}

/// Words of a text, and lines from where the words have come to; comments stand before a word, not between lines.
class OffText {
public:
  OffText(const char* begin, const char* end) : at_(begin), end_(end) {}

  std::string_view word() {
    skip_comments();
    const char* begin = at_;
    while (at_ < end_ && !is_space(*at_))
      ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }
  /// The next that is not blank; false: there is none.
  bool line(std::string_view& text) {
    skip_spaces();
    const char* begin = at_;
    skip_line();
    text = {begin, static_cast<std::size_t>(at_ - begin)};
    return !text.empty();
  }

  void skip_comments() {
    for (skip_spaces(); at_ < end_ && *at_ == '#'; skip_spaces())
      skip_line();
  }

private:
  void skip_spaces() {
    while (at_ < end_ && is_space(*at_))
      ++at_;
  }
  void skip_line() {
    while (at_ < end_ && *at_ != '\n' && *at_ != '\r')
      ++at_;
  }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  const char* at_;
  const char* end_;
};

std::uint32_t whole(const std::string& path, std::string_view word, const char* what) {
  std::uint32_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size())
    refuse(path, std::string("expected the number of ") + what + ", found " + quoted_bytes(word));
  return value;
}

void check_off(const InputFile& file) {
  constexpr std::uint32_t most_corners = 9; // of a face, that Assimp reads
  const std::string& path = file.path();
  const FileBytes bytes = read_whole_file(path);
  // Some of them end lines for Assimp, and would make faces of what are vertices here.
  const auto is_control = [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r';
  };
  if (std::any_of(bytes.data.get(), bytes.data.get() + bytes.size, is_control))
    refuse(path, "it has control characters, expected a text");
  OffText text(bytes.data.get(), bytes.data.get() + bytes.size);
  const std::string_view head = text.word();
  if (head.size() < 3 || head.substr(head.size() - 3) != "OFF")
    refuse(path, "it begins with " + quoted_bytes(head) + ", expected OFF");
  if (head.find('n') != std::string_view::npos) whole(path, text.word(), "dimensions");
  const std::uint32_t vertices = whole(path, text.word(), "vertices");
  const std::uint32_t faces = whole(path, text.word(), "faces");
  whole(path, text.word(), "edges");
  text.skip_comments();
  std::string_view line;
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (!text.line(line)) refuse(path, "it has " + std::to_string(v) + " of " + std::to_string(vertices) + " vertices");
  for (std::uint32_t f = 0; f < faces; ++f) {
    if (!text.line(line)) refuse(path, "it has " + std::to_string(f) + " of " + std::to_string(faces) + " faces");
    const std::string face = "face " + std::to_string(f + 1);
    OffText words(line.data(), line.data() + line.size());
    const std::uint32_t corners = whole(path, words.word(), (face + "'s corners").c_str());
    if (corners < 1 || corners > most_corners)
      refuse(path,
             face + " has " + std::to_string(corners) + " corners, expected 1 to " + std::to_string(most_corners));
    for (std::uint32_t c = 0; c < corners; ++c)
      if (whole(path, words.word(), (face + "'s vertex").c_str()) >= vertices)
        refuse(path, face + " names a vertex beyond the " + std::to_string(vertices) + " that there are");
  }
}

} // namespace

void check_mesh_file(const std::string& path) {
  const InputFile file(path);
  check_glb(file);
  if (has_extension(path, ".off")) check_off(file);
  if (has_extension(path, ".gltf") || has_extension(path, ".glb")) check_gltf(file);
}

void prepare_to_cut(aiMesh& mesh, const std::string& path) {
  bool has_polygon = false;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    has_polygon = has_polygon || face.mNumIndices > 3;
    for (unsigned k = 0; k < face.mNumIndices; ++k)
      if (face.mIndices[k] >= mesh.mNumVertices)
        refuse(path, "face " + std::to_string(f + 1) + " names vertex " + std::to_string(face.mIndices[k]) + " of " +
                         std::to_string(mesh.mNumVertices) + ", counted from 0");
  }
  if (!has_polygon) mesh.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
}

} // namespace pointgi
