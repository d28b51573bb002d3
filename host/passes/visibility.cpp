#include "host/passes/visibility.h"
#include <algorithm>

namespace pointgi {

namespace {

/// A launch aims at this: short for a watchdog, long against the cost of launching.
constexpr double launch_seconds = 0.1;
/// Segments of the first launch, of which nothing is known yet, and of any.
constexpr std::size_t first_at_once = 1u << 14, most_at_once = 1u << 22;

} // namespace

DeviceVisibility::DeviceVisibility(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                   View<Splat> points, float step_delta)
    : session_(session), pools_(pools), group_(variant.group.size()), step_delta_(step_delta),
      points_(session.upload(points.data, points.size)), at_once_(first_at_once) {
  const Program program = segments_program(variant);
  kernel_ = session.kernel(program.file, program.options, "segments_blocked");
}

std::vector<std::uint8_t> DeviceVisibility::blocked(View<Segment> segments) {
  std::vector<std::uint8_t> answers;
  answers.reserve(segments.size);
  for (std::size_t done = 0; done < segments.size;) {
    const std::size_t count = std::min(at_once_, segments.size - done);
    const auto queries = session_.upload(segments.data + done, count);
    const auto blocked = session_.allocate<std::uint8_t>(count, CL_MEM_WRITE_ONLY);
    const double seconds =
        session_.launch(kernel_, LaunchShape::line(count, group_), pools_.nodes, pools_.leaves, pools_.points, points_,
                        queries, blocked, static_cast<cl_uint>(count), step_delta_);
    const auto part = session_.download(blocked, count);
    answers.insert(answers.end(), part.begin(), part.end());
    done += count;
    if (seconds < 0.5 * launch_seconds && count == at_once_) at_once_ = std::min(2 * at_once_, most_at_once);
    if (seconds > 2.0 * launch_seconds) at_once_ = std::max(at_once_ / 2, first_at_once / 16);
  }
  return answers;
}

} // namespace pointgi
