#pragma once
/// Files of records of one length, taken in pieces that lie in memory only while they are looked at.
#include "host/cloud/input_file.h"
#include "octree/parallel.h"
#include <algorithm>
#include <atomic>
#include <memory>

namespace pointgi {

namespace detail {
inline std::size_t records_each(std::size_t record_bytes) {
  return std::max<std::size_t>(1, (std::size_t{1} << 20) / record_bytes);
}

inline std::unique_ptr<char[]> read_records(const InputFile& file, std::uint64_t begin, std::size_t record_bytes,
                                            std::size_t first, std::size_t end) {
  std::unique_ptr<char[]> records(new char[(end - first) * record_bytes]);
  file.read(begin + static_cast<std::uint64_t>(first) * record_bytes, records.get(), (end - first) * record_bytes);
  return records;
}
} // namespace detail

/// Calls body(first, end, bytes) for the records [first, end) of `count` records of `record_bytes` bytes from byte
/// `begin` of the file on; on all cores, in any order. A piece is a megabyte, or one record where that is longer.
template <class Body>
void for_each_piece(const InputFile& file, std::uint64_t begin, std::size_t record_bytes, std::size_t count,
                    const Body& body) {
  parallel_ranges(count, detail::records_each(record_bytes), [&](std::size_t first, std::size_t end) {
    const std::unique_ptr<char[]> records = detail::read_records(file, begin, record_bytes, first, end);
    body(first, end, static_cast<const char*>(records.get()));
  });
}

/// The same on this thread, piece after piece.
template <class Body>
void for_each_piece_in_order(const InputFile& file, std::uint64_t begin, std::size_t record_bytes, std::size_t count,
                             const Body& body) {
  const std::size_t each = detail::records_each(record_bytes);
  for (std::size_t first = 0; first < count; first += each) {
    const std::size_t end = std::min(first + each, count);
    const std::unique_ptr<char[]> records = detail::read_records(file, begin, record_bytes, first, end);
    body(first, end, static_cast<const char*>(records.get()));
  }
}

/// Whether test(record) is true for any of the records; those behind the first such piece are not all read.
template <class Test>
bool any_record(const InputFile& file, std::uint64_t begin, std::size_t record_bytes, std::size_t count,
                const Test& test) {
  std::atomic<bool> found{false};
  parallel_ranges(count, detail::records_each(record_bytes), [&](std::size_t first, std::size_t end) {
    if (found) return;
    const std::unique_ptr<char[]> records = detail::read_records(file, begin, record_bytes, first, end);
    for (std::size_t i = 0; i < end - first && !found; ++i)
      if (test(static_cast<const char*>(records.get()) + i * record_bytes)) found = true;
  });
  return found;
}

} // namespace pointgi
