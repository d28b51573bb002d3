#pragma once
/// What the tests of pictures share: a folder that goes away, and pictures of random numbers.
#include "host/image/picture_writer.h"
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <stdlib.h>
#include <string>
#include <vector>

namespace pointgi::test::picture {

/// An empty folder of this test's own, removed with all it holds.
class Folder {
public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "pointgi_picture_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot create " + pattern);
    path_ = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

  /// The names in the folder, sorted: hidden temporary files would show.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void put_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// The channels of interface.md.
inline std::vector<ChannelName> all_channels() {
  std::vector<ChannelName> channels;
  for (const char* name :
       {"R",         "G",         "B",          "A",          "Direct.R",  "Direct.G",   "Direct.B",   "Diffuse.R",
        "Diffuse.G", "Diffuse.B", "Caustic.R",  "Caustic.G",  "Caustic.B", "Specular.R", "Specular.G", "Specular.B",
        "Albedo.R",  "Albedo.G",  "Albedo.B",   "N.X",        "N.Y",       "N.Z",        "P.X",        "P.Y",
        "P.Z",       "Z",         "Variance.R", "Variance.G", "Variance.B"})
    channels.push_back({name, false});
  channels.push_back({"PointId", true});
  return channels;
}

inline std::vector<ChannelName> rgb_channels() {
  return {{"R", false}, {"G", false}, {"B", false}};
}

/// Random bits, which no codec can shrink; float channels stay finite, so that they compare by ==.
inline Band random_band(const std::vector<ChannelName>& channels, int first_row, int rows, int width, unsigned seed) {
  std::mt19937 random(seed);
  Band band{first_row, rows, width, {}};
  for (const ChannelName& channel : channels) {
    std::vector<float> values(static_cast<std::size_t>(rows) * static_cast<std::size_t>(width));
    for (float& value : values) {
      std::uint32_t bits = static_cast<std::uint32_t>(random());
      // An exponent of all ones is NaN or infinity: clear its lowest bit.
      if (!channel.is_uint && (bits & 0x7f800000u) == 0x7f800000u) bits &= ~0x00800000u;
      std::memcpy(&value, &bits, sizeof value);
    }
    band.values.push_back(values);
  }
  return band;
}

} // namespace pointgi::test::picture
