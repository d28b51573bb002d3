#include "host/cloud/readers/gunzip.h"
#include "host/error.h"
#include <algorithm>
#include <vector>
#include <zlib.h>

namespace pointgi {

namespace {

constexpr int gzip_only = 16 + MAX_WBITS;
constexpr std::size_t most_at_once = std::size_t{1} << 30; // zlib counts with 32 bits

} // namespace

struct Gunzip::Stream {
  z_stream z{};
  const char* next; ///< what zlib was not given yet
  std::size_t left;

  Stream(const char* data, std::size_t size) : next(data), left(size) {
    if (inflateInit2(&z, gzip_only) != Z_OK) throw Error(ErrorKind::memory, "zlib can't be started; free some memory");
  }
  ~Stream() { inflateEnd(&z); }

  /// As inflate(), with the input topped up.
  int inflate_into(unsigned char* to, std::size_t& bytes) {
    if (z.avail_in == 0) {
      const std::size_t piece = std::min(left, most_at_once);
      z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(next));
      z.avail_in = static_cast<uInt>(piece);
      next += piece;
      left -= piece;
    }
    const std::size_t room = std::min(bytes, most_at_once);
    z.next_out = to;
    z.avail_out = static_cast<uInt>(room);
    const int result = inflate(&z, Z_NO_FLUSH);
    bytes = room - z.avail_out;
    return result;
  }
};

Gunzip::Gunzip(const char* data, std::size_t size, const std::string& file) : file_(file), packed_bytes_(size) {
  if (!is_gzip(data, size))
    throw Error(ErrorKind::input,
                file + ": byte 0: expected gzip data, which SPZ is packed with; this is another file");
  stream_ = std::make_unique<Stream>(data, size);
}

Gunzip::~Gunzip() = default;

void Gunzip::fail(const std::string& what) const {
  throw Error(ErrorKind::input, file_ + ": byte " + std::to_string(done_) + " of the unpacked data: " + what);
}

void Gunzip::fail_unpacking(int result) const {
  if (result == Z_BUF_ERROR) fail("the packed data end; the file is cut off");
  const char* reason = stream_->z.msg; // of zlib's own texts
  fail("the packed data are damaged (" + std::string(reason != nullptr ? reason : "no reason given") +
       "); get the file again");
}

void Gunzip::expect(std::size_t bytes) const {
  constexpr std::size_t best_ratio = 1032;
  if (bytes / best_ratio > packed_bytes_)
    fail("the header announces " + std::to_string(bytes) + " bytes, which " + std::to_string(packed_bytes_) +
         " packed bytes can't hold; the file is damaged");
}

void Gunzip::read(unsigned char* to, std::size_t bytes) {
  while (bytes > 0) {
    if (ended_) fail("the data end, " + std::to_string(bytes) + " bytes are missing; the file is damaged");
    std::size_t got = bytes;
    const int result = stream_->inflate_into(to, got);
    to += got;
    done_ += got;
    bytes -= got;
    ended_ = result == Z_STREAM_END;
    if (ended_ || result == Z_OK) continue;
    fail_unpacking(result);
  }
}

void Gunzip::skip(std::size_t bytes) {
  std::vector<unsigned char> scratch(std::min<std::size_t>(bytes, 1 << 16));
  for (; bytes > 0; bytes -= std::min(bytes, scratch.size()))
    read(scratch.data(), std::min(bytes, scratch.size()));
}

void Gunzip::finish() {
  while (!ended_) {
    unsigned char more = 0;
    std::size_t got = 1;
    const int result = stream_->inflate_into(&more, got);
    if (got > 0) fail("more data follow than the header announces; the file is damaged");
    ended_ = result == Z_STREAM_END;
    if (!ended_ && result != Z_OK) fail_unpacking(result);
  }
}

bool Gunzip::is_gzip(const char* data, std::size_t size) {
  return size >= 2 && data[0] == '\x1f' && data[1] == '\x8b';
}

bool Gunzip::peek(const char* data, std::size_t size, unsigned char* to, std::size_t bytes) {
  try {
    Gunzip(data, size, "").read(to, bytes);
    return true;
  } catch (const Error&) {
    return false;
  }
}

} // namespace pointgi
