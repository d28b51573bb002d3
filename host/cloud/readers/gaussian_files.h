#pragma once
/// Files of Gaussians other than plain PLY: .splat, .spz and the compressed PLY of SuperSplat. Each gives the fields
/// of the plain PLY, so that what is asked for by a field's name is the same for all of them.
#include "host/cloud/readers/readers.h"

namespace pointgi {

/// 32 bytes a Gaussian, without a header: position and axes (3 floats each), red green blue opacity (bytes), quaternion
/// (bytes, 128 is 0). Throws Error(input) with the byte: no records, or a part of one at the end.
PointCloud read_splat(const std::string& path, const ReadRequest& request, CloudReport& report);

/// SPZ versions 1 to 3: gzip around a header of 16 bytes and one array for each value. Harmonics are passed over.
/// Throws Error(input) with the byte of the unpacked data: another magic number or version, a count that the file
/// can't hold, damaged or missing data.
PointCloud read_spz(const std::string& path, const ReadRequest& request, CloudReport& report);
bool recognises_spz(const char* data, std::size_t size);

/// SuperSplat's PLY: chunks of 256 Gaussians with their bounds, and four integers a Gaussian between them.
/// Throws Error(input) with the line or byte: properties that are missing, fewer chunks than the Gaussians take, a body
/// that is cut off.
PointCloud read_compressed_ply(const std::string& path, const ReadRequest& request, CloudReport& report);
bool recognises_compressed_ply(const char* data, std::size_t size);

} // namespace pointgi
