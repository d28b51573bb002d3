#pragma once
/// The points of a LAZ file: chunks that are decoded on their own, into the records that the LAS file had.
#include "host/cloud/input_file.h"
#include "host/cloud/readers/laz_items.h"
#include <string>
#include <vector>

namespace pointgi {

class LazChunks {
public:
  /// `points` records of `record_bytes` bytes that begin (compressed) at byte `begin`; `description`: the content of
  /// the record "laszip encoded". Throws Error(input) naming the byte: kinds of compression that are not known (with
  /// what reads them), a table of chunks that does not fit, more points than the file can hold.
  LazChunks(const InputFile& file, std::uint64_t begin, std::uint64_t points, std::size_t record_bytes,
            const std::string& description);

  std::size_t size() const { return chunks_.size(); }
  std::uint64_t first(std::size_t chunk) const { return chunks_[chunk].first; } ///< its first point
  std::uint64_t count(std::size_t chunk) const { return chunks_[chunk].count; }
  /// The records of a chunk. Several threads may decode at once. Throws Error(input).
  std::vector<char> decode(std::size_t chunk) const;

private:
  struct Chunk {
    std::uint64_t begin, bytes, first, count;
  };
  [[noreturn]] void fail(std::uint64_t byte, const std::string& what) const;
  void parse_description(const std::string& description);
  void read_table(std::uint64_t begin, std::uint64_t points);
  std::vector<char> decode_points(const std::vector<char>& bytes, const Chunk& chunk) const;
  std::vector<char> decode_layers(const std::vector<char>& bytes, const Chunk& chunk) const;

  const InputFile& file_;
  std::size_t record_bytes_;
  unsigned compressor_ = 0;
  std::uint32_t chunk_points_ = 0; ///< 0xffffffff: the table says how many
  std::vector<LazItem> items_;
  std::vector<Chunk> chunks_;
};

} // namespace pointgi
