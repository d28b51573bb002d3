#include "host/passes/tile_renderer.h"

namespace pointgi {

TileRenderer::TileRenderer(Session& session, const DevicePools& pools, const DeviceLighting& lighting, double side,
                           const TraversalVariant& variant)
    : session_(session), pools_(pools), params_(lighting.params), grouping_(variant.grouping), group_(variant.group) {
  params_.step_delta = static_cast<float>(variant.step_delta / side);
  const SceneFeatures features{!lighting.delta.empty(), !lighting.emitters.empty(), lighting.has_environment};
  const Program program = render_program(variant, features);
  kernel_ = session.kernel(program.file, program.options, "render_pixels");
  device_params_ = session.upload(&params_, 1);
  materials_ = session.upload(lighting.materials);
  delta_ = session.upload(lighting.delta);
  emitters_ = session.upload(lighting.emitters);
}

double TileRenderer::launch(int x, int y, int columns, int rows, pg_uint first_sample) {
  const auto width = static_cast<std::size_t>(columns), height = static_cast<std::size_t>(rows);
  if (film_.size < width * height * FILM_CHANNELS) film_ = session_.allocate<float>(width * height * FILM_CHANNELS);
  const std::size_t pixels_a_group = group_.size() / GRID_RAYS;
  const LaunchShape shape = grouping_ == RayGrouping::packet
                                ? LaunchShape::grid(width, height, group_.x, group_.y)
                                : LaunchShape::grid((width + pixels_a_group - 1) / pixels_a_group * group_.x,
                                                    height * group_.y, group_.x, group_.y);
  const auto number = [](auto value) { return static_cast<cl_uint>(value); };
  return session_.launch(kernel_, shape, pools_.nodes, pools_.leaves, pools_.points, device_params_, materials_, delta_,
                         emitters_, film_, number(x), number(y), number(columns), number(rows), number(first_sample));
}

std::vector<float> TileRenderer::film(int columns, int rows) {
  return session_.download(film_, static_cast<std::size_t>(columns) * rows * FILM_CHANNELS);
}

} // namespace pointgi
