#include "host/passes/visibility.h"

namespace pointgi {

namespace {

/// Segments of the first launch, of which nothing is known yet, and of any.
constexpr std::size_t first_at_once = 1u << 14, most_at_once = 1u << 22;

} // namespace

DeviceVisibility::DeviceVisibility(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                   View<Splat> points, float step_delta)
    : session_(session), pools_(pools), group_(variant.group.size()), step_delta_(step_delta),
      points_(session.upload(points.data, points.size)),
      pace_(first_at_once, busy_work_items(session.info()), most_at_once) {
  const Program program = segments_program(variant);
  kernel_ = session.kernel(program.file, program.options, "segments_blocked");
}

std::vector<std::uint8_t> DeviceVisibility::blocked(View<Segment> segments) {
  std::vector<std::uint8_t> answers;
  answers.reserve(segments.size);
  for_each_batch(EqualItems{segments.size}, pace_, {}, [&](std::size_t first, std::size_t count) {
    const auto queries = session_.upload(segments.data + first, count);
    const auto blocked = session_.allocate<std::uint8_t>(count, CL_MEM_WRITE_ONLY);
    const double seconds =
        session_.launch(kernel_, LaunchShape::line(count, group_), pools_.nodes, pools_.leaves, pools_.points, points_,
                        queries, blocked, static_cast<cl_uint>(count), step_delta_);
    const auto part = session_.download(blocked, count);
    answers.insert(answers.end(), part.begin(), part.end());
    return seconds;
  });
  return answers;
}

} // namespace pointgi
