#pragma once
/// The point records of a LAS file, compressed or not.
#include "host/cloud/readers/las_header.h"
#include "host/cloud/readers/laz_chunks.h"
#include "host/cloud/readers/record_pieces.h"
#include <optional>

namespace pointgi {

class LasRecords {
public:
  /// Throws Error(input) for compressed points that are not understood, with what reads them.
  LasRecords(const InputFile& file, const LasHeader& header) : file_(file), header_(header) {
    if (!header.is_compressed) return;
    const LasVlr* vlr = header.find("laszip encoded", 22204);
    std::string description(vlr == nullptr ? 0 : static_cast<std::size_t>(vlr->bytes), '\0');
    if (vlr != nullptr) file.read(vlr->data, description.data(), description.size());
    chunks_.emplace(file, header.points_begin, header.points, header.record_bytes, description);
  }

  /// Calls body(first, end, bytes) for the records [first, end); on all cores, in any order.
  template <class Body>
  void for_each_piece(const Body& body) const {
    if (!chunks_)
      return pointgi::for_each_piece(file_, header_.points_begin, header_.record_bytes,
                                     static_cast<std::size_t>(header_.points), body);
    parallel_ranges(chunks_->size(), 1, [&](std::size_t chunk, std::size_t) {
      const std::vector<char> records = chunks_->decode(chunk);
      const auto first = static_cast<std::size_t>(chunks_->first(chunk));
      body(first, first + static_cast<std::size_t>(chunks_->count(chunk)), records.data());
    });
  }

  /// The same on this thread, piece after piece.
  template <class Body>
  void for_each_piece_in_order(const Body& body) const {
    if (!chunks_)
      return pointgi::for_each_piece_in_order(file_, header_.points_begin, header_.record_bytes,
                                              static_cast<std::size_t>(header_.points), body);
    for (std::size_t chunk = 0; chunk < chunks_->size(); ++chunk) {
      const std::vector<char> records = chunks_->decode(chunk);
      const auto first = static_cast<std::size_t>(chunks_->first(chunk));
      body(first, first + static_cast<std::size_t>(chunks_->count(chunk)), records.data());
    }
  }

  /// Whether test(record) is true for any of the records.
  template <class Test>
  bool any(const Test& test) const {
    if (!chunks_)
      return any_record(file_, header_.points_begin, header_.record_bytes, static_cast<std::size_t>(header_.points),
                        test);
    std::atomic<bool> found{false};
    parallel_ranges(chunks_->size(), 1, [&](std::size_t chunk, std::size_t) {
      if (found) return;
      const std::vector<char> records = chunks_->decode(chunk);
      for (std::size_t at = 0; at < records.size() && !found; at += header_.record_bytes)
        if (test(static_cast<const char*>(&records[at]))) found = true;
    });
    return found;
  }

private:
  const InputFile& file_;
  const LasHeader& header_;
  std::optional<LazChunks> chunks_;
};

} // namespace pointgi
