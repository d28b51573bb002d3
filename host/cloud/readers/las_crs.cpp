#include "host/cloud/readers/las_crs.h"
#include "host/cloud/readers/record_values.h"
#include <algorithm>

namespace pointgi {

namespace {

/// The content of a record, of long ones the beginning.
std::string content_of(const InputFile& file, const LasVlr* vlr) {
  constexpr std::uint64_t most = 65536;
  if (vlr == nullptr) return "";
  std::string bytes(static_cast<std::size_t>(std::min(vlr->bytes, most)), '\0');
  file.read(vlr->data, bytes.data(), bytes.size());
  return bytes;
}

bool holds(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

/// Keywords of WKT 1 and 2. A map's text holds the geographic system it is based on, so that the map is asked first.
LasCoordinates by_text(const std::string& wkt) {
  if (holds(wkt, {"PROJCS[", "PROJCRS[", "PROJECTEDCRS["})) return LasCoordinates::projected;
  if (holds(wkt, {"GEOCCS[", "CS[Cartesian,3]"})) return LasCoordinates::geocentric;
  if (holds(wkt, {"GEOGCS[", "GEOGCRS[", "GEOGRAPHICCRS[", "CS[ellipsoidal"})) return LasCoordinates::geographic;
  return LasCoordinates::unknown;
}

/// The value of a short GeoKey; 0 where it is not there. Four numbers a key behind a head of four: the key, where its
/// value is (0: here), how many, the value.
unsigned geo_key(const std::string& directory, unsigned key) {
  for (std::size_t at = 8; at + 8 <= directory.size(); at += 8) {
    const auto number = [&](std::size_t k) { return little_endian<std::uint16_t>(&directory[at + 2 * k]); };
    if (number(0) == key && number(1) == 0) return number(3);
  }
  return 0;
}

LasCoordinates by_keys(const std::string& directory) {
  const unsigned model = geo_key(directory, 1024); // GTModelTypeGeoKey
  if (model == 1) return LasCoordinates::projected;
  if (model == 2) return LasCoordinates::geographic;
  if (model == 3) return LasCoordinates::geocentric;
  if (geo_key(directory, 3072) != 0) return LasCoordinates::projected;  // ProjectedCSTypeGeoKey
  if (geo_key(directory, 2048) != 0) return LasCoordinates::geographic; // GeographicTypeGeoKey
  return LasCoordinates::unknown;
}

} // namespace

LasCoordinates las_coordinates(const InputFile& file, const LasHeader& header) {
  const LasCoordinates text = by_text(content_of(file, header.find("LASF_Projection", 2112)));
  const LasCoordinates keys = by_keys(content_of(file, header.find("LASF_Projection", 34735)));
  const LasCoordinates first = header.says_wkt ? text : keys;
  return first != LasCoordinates::unknown ? first : header.says_wkt ? keys : text;
}

} // namespace pointgi
