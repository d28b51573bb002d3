#pragma once
/// Marc Lehmann's LZF compression, which PCD files use.
#include <cstddef>

namespace pointgi {

/// A token of three bytes makes up to 264 bytes: more than so many times the input never comes out.
constexpr std::size_t lzf_most = 88;

/// Decompresses `size` bytes at `from` to exactly `expected` bytes at `to`. Returns the number of bytes that were made
/// sense of: `size` when all went well; else where the first fault is (a piece that ends early, looks back before the
/// beginning or makes too much), or `size` + 1 where too little came out.
std::size_t decompress_lzf(const char* from, std::size_t size, char* to, std::size_t expected);

} // namespace pointgi
