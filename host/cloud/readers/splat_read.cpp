#include "host/cloud/input_file.h"
#include "host/cloud/readers/gaussian_files.h"
#include "host/cloud/readers/gaussian_row.h"
#include "host/cloud/readers/point_sink.h"
#include "host/cloud/readers/record_pieces.h"
#include <cstring>
#include <limits>

namespace pointgi {

namespace {

constexpr std::size_t record_bytes = 32;

GaussianRow row_of(const char* record) {
  std::array<float, 6> floats;
  std::array<unsigned char, 8> bytes;
  std::memcpy(floats.data(), record, sizeof floats);
  std::memcpy(bytes.data(), record + sizeof floats, sizeof bytes);
  GaussianRow row;
  for (std::size_t k = 0; k < 3; ++k) {
    row.position[k] = static_cast<double>(floats[k]);
    row.log_scale[k] = std::log(static_cast<double>(floats[3 + k]));
    row.colour[k] = bytes[k] / 255.0;
  }
  row.opacity = bytes[3] / 255.0;
  for (std::size_t k = 0; k < 4; ++k)
    row.rotation[k] = (bytes[4 + k] - 128.0) / 128.0;
  return row;
}

} // namespace

PointCloud read_splat(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const InputFile file(path);
  const std::uint64_t count = file.size() / record_bytes;
  if (count == 0 || file.size() % record_bytes != 0 || count > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::input, path + ": byte " + std::to_string(count * record_bytes) + ": the file has " +
                                      std::to_string(file.size()) +
                                      " bytes, expected 32 for each of 1 to 4294967295 Gaussians; it is cut off or no "
                                      ".splat file");
  report.format = "splat";
  PointSink sink(plan_gaussians(request, path, report), count, path);
  for_each_piece(file, 0, record_bytes, count, [&](std::size_t first, std::size_t end, const char* bytes) {
    for (std::size_t i = first; i < end; ++i)
      sink.put(i, row_of(bytes + (i - first) * record_bytes).fields().data());
  });
  return sink.finish(report);
}

} // namespace pointgi
