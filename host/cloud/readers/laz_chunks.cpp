#include "host/cloud/readers/laz_chunks.h"
#include "host/cloud/readers/record_values.h"
#include <algorithm>
#include <cstring>

namespace pointgi {

namespace {

// Of the record "laszip encoded".
constexpr std::size_t at_compressor = 0, at_coder = 2, at_chunk_points = 12, at_item_count = 32, items_begin = 34,
                      item_bytes = 6;
enum Compressor : unsigned { one_chunk = 1, points_in_chunks = 2, layers_in_chunks = 3 };
constexpr std::uint32_t varying = 0xffffffff;

/// Points that repeat each other take next to nothing: so many points, and bytes of records, for a byte of the file are
/// believed, and no more.
constexpr std::uint64_t points_per_byte = 200, expansion = 8192;
/// A decoder looks a few bytes ahead; further behind the end nobody wrote anything.
constexpr std::size_t look_ahead = 16;

bool can_hold(std::uint64_t bytes, std::uint64_t points, std::size_t record_bytes) {
  return points / points_per_byte <= bytes && points <= bytes * expansion / record_bytes;
}

const unsigned char* unsigned_bytes(const char* bytes) {
  return reinterpret_cast<const unsigned char*>(bytes);
}

} // namespace

LazChunks::LazChunks(const InputFile& file, std::uint64_t begin, std::uint64_t points, std::size_t record_bytes,
                     const std::string& description)
    : file_(file), record_bytes_(record_bytes) {
  parse_description(description);
  if (begin > file.size() || !can_hold(file.size() - begin, points, record_bytes))
    fail(begin, std::to_string(points) + " compressed points from here on, which a file of " +
                    std::to_string(file.size()) + " bytes cannot hold; it is truncated or corrupt");
  if (compressor_ == one_chunk)
    chunks_.push_back({begin, file.size() - begin, 0, points});
  else
    read_table(begin, points);
}

void LazChunks::fail(std::uint64_t byte, const std::string& what) const {
  throw Error(ErrorKind::input, file_.path() + ": byte " + std::to_string(byte) + ": " + what);
}

void LazChunks::parse_description(const std::string& description) {
  const auto refuse = [&](const std::string& what) {
    fail(0, what + "; make a PLY file of it: `scripts/import " + file_.path() + " OUT.ply`");
  };
  if (description.size() < items_begin) refuse("the record \"laszip encoded\" is too short to tell the compression");
  compressor_ = little_endian<std::uint16_t>(&description[at_compressor]);
  const unsigned coder = little_endian<std::uint16_t>(&description[at_coder]);
  chunk_points_ = little_endian<std::uint32_t>(&description[at_chunk_points]);
  const std::size_t count = little_endian<std::uint16_t>(&description[at_item_count]);
  if (compressor_ < one_chunk || compressor_ > layers_in_chunks || coder != 0)
    refuse("a compression of kind " + std::to_string(compressor_) + ", expected 1 to 3");
  if (description.size() < items_begin + count * item_bytes)
    refuse("the record \"laszip encoded\" ends within its list of items");
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const char* at = &description[items_begin + i * item_bytes];
    items_.push_back(
        {little_endian<std::uint16_t>(at), little_endian<std::uint16_t>(at + 2), little_endian<std::uint16_t>(at + 4)});
    bytes += items_.back().bytes;
  }
  // Before any is made: models of many extra bytes are large, and each chunk stores a record as it is.
  if (bytes != record_bytes_ || bytes > file_.size() || items_.empty())
    refuse("items of " + std::to_string(bytes) + " bytes for records of " + std::to_string(record_bytes_));
  for (const LazItem& item : items_)
    if (compressor_ == layers_in_chunks ? make_layer_part(item) == nullptr : make_point_part(item) == nullptr)
      refuse("points with an item of type " + std::to_string(item.type) + ", version " + std::to_string(item.version) +
             ", are not read directly");
  if (compressor_ == layers_in_chunks && items_.front().type != 10) refuse("points whose first item is no point");
  if (chunk_points_ == 0) refuse("chunks of 0 points");
}

/// The table stands behind the chunks; a number before them tells where, or at the end of the file when it could not
/// be set.
void LazChunks::read_table(std::uint64_t begin, std::uint64_t points) {
  std::array<char, 8> bytes{};
  const auto number_at = [&](std::uint64_t byte) {
    if (byte > file_.size() - bytes.size()) fail(byte, "the file ends here; it is truncated");
    file_.read(byte, bytes.data(), bytes.size());
    return little_endian<std::uint64_t>(bytes.data());
  };
  if (file_.size() < begin + 2 * bytes.size()) fail(file_.size(), "the file ends before its points; it is truncated");
  std::uint64_t table = number_at(begin);
  if (table == ~std::uint64_t{0}) table = number_at(file_.size() - bytes.size());
  const std::uint64_t chunks_begin = begin + bytes.size();
  if (table < chunks_begin || table > file_.size() - bytes.size())
    fail(begin, "the table of chunks is at byte " + std::to_string(table) +
                    ", which is not behind the points; the file is truncated or corrupt");
  const std::uint64_t head = number_at(table);
  const std::uint64_t count = head >> 32;
  const std::uint64_t expected = (points + chunk_points_ - 1) / chunk_points_;
  const std::uint64_t most = (table - chunks_begin) / record_bytes_; // each stores its first point as it is
  if (count > most || (chunk_points_ != varying && count < expected))
    fail(table + 4, "a table of " + std::to_string(count) + " chunks, expected " +
                        std::to_string(chunk_points_ == varying ? 1 : expected) + " to " + std::to_string(most) +
                        "; the file is truncated or corrupt");
  std::vector<char> packed(static_cast<std::size_t>(file_.size() - table - bytes.size()));
  file_.read(table + bytes.size(), packed.data(), packed.size());
  LazDecoder decoder(unsigned_bytes(packed.data()), packed.size());
  LazIntegers numbers(32, 2);
  std::int32_t last_points = 0, last_bytes = 0;
  std::uint64_t at = chunks_begin, first = 0;
  for (std::uint64_t c = 0; c < count && first < points; ++c) {
    if (chunk_points_ == varying) last_points = numbers.decode(decoder, last_points, 0);
    last_bytes = numbers.decode(decoder, last_bytes, 1);
    const std::uint64_t in_chunk = std::min<std::uint64_t>(
        points - first, chunk_points_ == varying ? static_cast<std::uint32_t>(last_points) : chunk_points_);
    const std::uint64_t size = static_cast<std::uint32_t>(last_bytes);
    if (size > table - at || (in_chunk > 0 && size < record_bytes_) || decoder.overrun() > look_ahead)
      fail(table, "the table of chunks gives chunk " + std::to_string(c) + " " + std::to_string(size) +
                      " bytes, which do not fit; the file is truncated or corrupt");
    if (in_chunk > 0) chunks_.push_back({at, size, first, in_chunk});
    at += size;
    first += in_chunk;
  }
  if (first < points)
    fail(table, "the chunks hold " + std::to_string(first) + " points, the header counts " + std::to_string(points) +
                    "; the file is truncated or corrupt");
}

std::vector<char> LazChunks::decode(std::size_t index) const {
  const Chunk& chunk = chunks_[index];
  std::vector<char> bytes(static_cast<std::size_t>(chunk.bytes));
  file_.read(chunk.begin, bytes.data(), bytes.size());
  if (!can_hold(chunk.bytes, chunk.count, record_bytes_) || bytes.size() < record_bytes_)
    fail(chunk.begin, "a chunk of " + std::to_string(chunk.bytes) + " bytes cannot hold " +
                          std::to_string(chunk.count) + " points; the file is corrupt");
  return compressor_ == layers_in_chunks ? decode_layers(bytes, chunk) : decode_points(bytes, chunk);
}

std::vector<char> LazChunks::decode_points(const std::vector<char>& bytes, const Chunk& chunk) const {
  std::vector<char> records(static_cast<std::size_t>(chunk.count) * record_bytes_);
  std::copy_n(bytes.begin(), record_bytes_, records.begin());
  std::vector<std::unique_ptr<LazPointPart>> parts;
  std::size_t offset = 0;
  for (const LazItem& item : items_) {
    parts.push_back(make_point_part(item));
    parts.back()->begin(unsigned_bytes(bytes.data()) + offset);
    offset += item.bytes;
  }
  LazDecoder decoder(unsigned_bytes(bytes.data()) + record_bytes_, bytes.size() - record_bytes_);
  auto* at = reinterpret_cast<unsigned char*>(records.data());
  for (std::uint64_t i = 1; i < chunk.count; ++i) {
    at += record_bytes_;
    offset = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      parts[p]->next(decoder, at + offset);
      offset += items_[p].bytes;
    }
    if (decoder.overrun() > look_ahead)
      fail(chunk.begin, "the chunk from here on ends before its point " + std::to_string(i) + " of " +
                            std::to_string(chunk.count) + "; the file is damaged");
  }
  return records;
}

std::vector<char> LazChunks::decode_layers(const std::vector<char>& bytes, const Chunk& chunk) const {
  std::vector<char> records(static_cast<std::size_t>(chunk.count) * record_bytes_);
  std::copy_n(bytes.begin(), record_bytes_, records.begin());
  const unsigned char* begin = unsigned_bytes(bytes.data());
  unsigned channel = begin[15] >> 4 & 3;
  std::vector<std::unique_ptr<LazLayerPart>> parts;
  std::vector<std::size_t> first_layer;
  std::size_t offset = 0, layer_count = 0;
  for (const LazItem& item : items_) {
    parts.push_back(make_layer_part(item));
    parts.back()->begin(begin + offset, channel);
    offset += item.bytes;
    first_layer.push_back(layer_count);
    layer_count += parts.back()->layers();
  }
  if (chunk.count == 1) return records; // which some writers end here
  // The number of points, and of the bytes of each layer; then the layers.
  std::size_t sizes = record_bytes_ + 4, at_layer = sizes + 4 * layer_count;
  if (at_layer > bytes.size())
    fail(chunk.begin, "the chunk from here on is shorter than its head; the file is damaged");
  std::vector<LazLayer> layers(layer_count);
  for (LazLayer& layer : layers) {
    const std::size_t size = little_endian<std::uint32_t>(&bytes[sizes]);
    sizes += 4;
    if (size > bytes.size() - at_layer)
      fail(chunk.begin, "a layer of the chunk from here on goes beyond it; the file is damaged");
    layer.is_empty = size == 0;
    if (size > 0) layer.decoder = LazDecoder(begin + at_layer, size);
    at_layer += size;
  }
  auto* at = reinterpret_cast<unsigned char*>(records.data());
  for (std::uint64_t i = 1; i < chunk.count; ++i) {
    at += record_bytes_;
    offset = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      parts[p]->next(&layers[first_layer[p]], channel, at + offset);
      offset += items_[p].bytes;
    }
    if (layers.front().decoder.overrun() > look_ahead)
      fail(chunk.begin, "the chunk from here on ends before its point " + std::to_string(i) + " of " +
                            std::to_string(chunk.count) + "; the file is damaged");
  }
  return records;
}

} // namespace pointgi
