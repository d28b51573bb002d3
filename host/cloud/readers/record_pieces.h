#pragma once
/// Files of records of one length, taken in pieces that lie in memory only while they are looked at.
#include "host/cloud/input_file.h"
#include "octree/parallel.h"
#include <algorithm>
#include <memory>

namespace pointgi {

/// Calls body(first, end, bytes) for the records [first, end) of `count` records of `record_bytes` bytes from byte
/// `begin` of the file on; on all cores, in any order. A piece is a megabyte, or one record where that is longer.
template <class Body>
void for_each_piece(const InputFile& file, std::uint64_t begin, std::size_t record_bytes, std::size_t count,
                    const Body& body) {
  const std::size_t records_each = std::max<std::size_t>(1, (std::size_t{1} << 20) / record_bytes);
  parallel_ranges(count, records_each, [&](std::size_t first, std::size_t end) {
    const std::size_t bytes = (end - first) * record_bytes;
    const std::unique_ptr<char[]> piece(new char[bytes]);
    file.read(begin + static_cast<std::uint64_t>(first) * record_bytes, piece.get(), bytes);
    body(first, end, piece.get());
  });
}

} // namespace pointgi
