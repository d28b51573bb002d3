#pragma once
/// Radiance pictures (.hdr, .pic): Ward, "Real Pixels", Graphics Gems II, 1991, and "Radiance File Formats".
#include "host/image/rgb_image.h"
#include <string>
#include <string_view>

namespace pointgi {

/// Longest side of a picture that is read.
inline constexpr int hdr_side = 65536;

/// The picture in `bytes`, a whole file, in radiance: pixels are mantissa * 2^(exponent - 136) over the product of the
/// header's EXPOSURE and COLORCORR lines. Scan lines flat, of the old run-length code and of the new one; all four
/// orders whose lines are rows. Memory grows with what is decoded, so that a damaged header asks for none. `path` is
/// for errors. Throws Error(input) with the byte at which the file is wrong or ends, and Error(input) for XYZE and for
/// pictures of more than `most_pixels`.
RgbImage decode_hdr(std::string_view bytes, const std::string& path, std::size_t most_pixels);

} // namespace pointgi
