#include "host/cloud/readers/e57_file.h"
#include "host/cloud/readers/record_values.h"
#include <algorithm>
#include <array>

namespace pointgi {

namespace {

constexpr std::size_t header_bytes = 48, checksum_bytes = 4;
constexpr std::size_t at_major = 8, at_length = 16, at_xml = 24, at_xml_bytes = 32, at_page_bytes = 40;
constexpr std::uint64_t largest_page = 1 << 20;

/// CRC-32C (Castagnoli), bit-reflected.
std::uint32_t checksum(const unsigned char* bytes, std::size_t count) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> entries{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit)
        value = value >> 1 ^ ((value & 1) != 0 ? 0x82f63b78u : 0u);
      entries[i] = value;
    }
    return entries;
  }();
  std::uint32_t value = 0xffffffff;
  for (std::size_t i = 0; i < count; ++i)
    value = value >> 8 ^ table[(value ^ bytes[i]) & 255];
  return ~value;
}

/// Checksums are the only numbers of an E57 file with the highest byte first.
std::uint32_t big_endian(const unsigned char* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

} // namespace

bool is_e57(const char* data, std::size_t size) {
  return std::string_view(data, size).substr(0, 8) == "ASTM-E57";
}

E57File::E57File(const std::string& path) : file_(path) {
  const auto fail_at = [&](std::size_t byte, const std::string& what) {
    throw Error(ErrorKind::input, path + ": byte " + std::to_string(byte) + ": " + what);
  };
  std::array<char, header_bytes> header{};
  const auto present = static_cast<std::size_t>(std::min<std::uint64_t>(file_.size(), header.size()));
  file_.read(0, header.data(), present);
  if (!is_e57(header.data(), present))
    fail_at(0, "expected \"ASTM-E57\", found " + quoted_bytes({header.data(), std::min<std::size_t>(present, 8)}));
  if (present < header_bytes) fail_at(present, "the file ends within its header; it is truncated");
  const auto major = little_endian<std::uint32_t>(&header[at_major]);
  if (major != 1) fail_at(at_major, "version " + std::to_string(major) + " of E57, expected 1; save it again as 1.0");
  page_bytes_ = little_endian<std::uint64_t>(&header[at_page_bytes]);
  if (page_bytes_ < header_bytes + checksum_bytes || page_bytes_ > largest_page)
    fail_at(at_page_bytes, "pages of " + std::to_string(page_bytes_) + " bytes, expected 1024; the file is corrupt");
  content_bytes_ = page_bytes_ - checksum_bytes;
  const auto length = little_endian<std::uint64_t>(&header[at_length]);
  if (length > file_.size())
    fail_at(at_length, "the file says that it has " + std::to_string(length) + " bytes, and has " +
                           std::to_string(file_.size()) + "; it is truncated");
  logical_bytes_ = file_.size() / page_bytes_ * content_bytes_;
  xml_begin_ = logical(little_endian<std::uint64_t>(&header[at_xml]), "the description (XML)");
  xml_bytes_ = little_endian<std::uint64_t>(&header[at_xml_bytes]);
  if (xml_bytes_ > logical_bytes_ - xml_begin_)
    fail_at(at_xml_bytes, "a description of " + std::to_string(xml_bytes_) + " bytes, the file has room for " +
                              std::to_string(logical_bytes_ - xml_begin_) + "; it is truncated or corrupt");
}

std::uint64_t E57File::logical(std::uint64_t physical, const std::string& what) const {
  const std::uint64_t within = physical % page_bytes_;
  const std::uint64_t place = physical / page_bytes_ * content_bytes_ + within;
  if (within >= content_bytes_ || place >= logical_bytes_)
    throw Error(ErrorKind::input, path() + ": byte " + std::to_string(physical) + ": " + what +
                                      " cannot lie there in a file of " + std::to_string(file_.size()) +
                                      " bytes; it is truncated or corrupt");
  return place;
}

void E57File::read(std::uint64_t begin, void* to, std::uint64_t count) const {
  if (begin > logical_bytes_ || count > logical_bytes_ - begin)
    fail(std::min(begin, logical_bytes_), "the file ends within what it announces; it is truncated or corrupt");
  const std::uint64_t pages_at_once = std::max<std::uint64_t>(1, (std::uint64_t{1} << 20) / page_bytes_);
  std::vector<unsigned char> pages;
  auto* target = static_cast<char*>(to);
  while (count > 0) {
    const std::uint64_t first = begin / content_bytes_;
    const std::uint64_t last = std::min((begin + count - 1) / content_bytes_, first + pages_at_once - 1);
    pages.resize((last - first + 1) * page_bytes_);
    file_.read(first * page_bytes_, pages.data(), pages.size());
    for (std::uint64_t page = first; page <= last; ++page) {
      const unsigned char* bytes = pages.data() + (page - first) * page_bytes_;
      if (checksum(bytes, content_bytes_) != big_endian(bytes + content_bytes_))
        fail(page * content_bytes_,
             "the checksum of the page from here on is wrong; the file is damaged, copy it anew");
      const std::uint64_t skip = begin - page * content_bytes_;
      const std::uint64_t part = std::min(count, content_bytes_ - skip);
      std::copy_n(bytes + skip, part, target);
      target += part;
      begin += part;
      count -= part;
    }
  }
}

std::vector<char> E57File::read(std::uint64_t begin, std::uint64_t count) const {
  if (begin > logical_bytes_ || count > logical_bytes_ - begin)
    fail(std::min(begin, logical_bytes_), "the file ends within what it announces; it is truncated or corrupt");
  std::vector<char> bytes(count);
  read(begin, bytes.data(), count);
  return bytes;
}

void E57File::fail(std::uint64_t place, const std::string& what) const {
  const std::uint64_t physical = place / content_bytes_ * page_bytes_ + place % content_bytes_;
  throw Error(ErrorKind::input, path() + ": byte " + std::to_string(physical) + ": " + what);
}

} // namespace pointgi
