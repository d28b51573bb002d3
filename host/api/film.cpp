#include "host/api/parts.h"
#include "host/image/exr_writer.h"
#include "host/image/png_writer.h"
#include "host/run.h"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace pointgi::api {

struct Film::Parts {
  Band rows; ///< all of the window
  std::vector<std::uint32_t> point_ids;
  std::vector<ChannelName> channels;
  PictureAttributes attributes;
  PixelWindow window;
  int full_width = 0, full_height = 0;
  double seconds = 0.0;

  void add(const Band& band) {
    rows.rows += band.rows;
    rows.values.resize(channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c)
      rows.values[c].insert(rows.values[c].end(), band.values[c].begin(), band.values[c].end());
  }

  /// Index of a channel; the number of channels where there is none of that name.
  std::size_t index_of(const std::string& name) const {
    const auto is_it = [&](const ChannelName& channel) { return channel.name == name; };
    return static_cast<std::size_t>(std::find_if(channels.begin(), channels.end(), is_it) - channels.begin());
  }

  void find_point_ids() {
    const std::vector<float>& bits = rows.values[index_of("PointId")];
    point_ids.resize(bits.size());
    std::memcpy(point_ids.data(), bits.data(), bits.size() * sizeof(float));
  }
};

Film::Film(const Light& light, const FilmOptions& options, const RunControl& run) {
  const RunScope scope(run);
  FilmJob job(*light.parts(), options);
  const auto parts = std::make_shared<Parts>();
  parts->channels = job.channels();
  parts->attributes = job.attributes();
  parts->window = job.window();
  parts->full_width = job.settings().width;
  parts->full_height = job.settings().height;
  parts->rows.first_row = parts->window.y0;
  parts->rows.width = parts->window.x1 - parts->window.x0;
  const RenderTotals totals = job.render([&](const Band& band) { parts->add(band); });
  if (totals.interrupted) throw interruption();
  job.warn(totals);
  parts->seconds = light.parts()->prepared->context->stages.records().back().seconds;
  parts->find_point_ids();
  parts_ = parts;
}

int Film::width() const {
  return parts_->rows.width;
}

int Film::height() const {
  return parts_->rows.rows;
}

std::vector<std::string> Film::channels() const {
  std::vector<std::string> names;
  for (const ChannelName& channel : parts_->channels)
    if (!channel.is_uint) names.push_back(channel.name);
  return names;
}

const std::vector<float>& Film::channel(const std::string& name) const {
  const std::size_t at = parts_->index_of(name);
  if (at < parts_->channels.size() && !parts_->channels[at].is_uint) return parts_->rows.values[at];
  std::string list;
  for (const std::string& known : channels())
    list += (list.empty() ? "" : ", ") + known;
  throw Error(ErrorKind::usage, "the film has no channel \"" + name + "\"; its channels are: " + list);
}

const std::vector<std::uint32_t>& Film::point_ids() const {
  return parts_->point_ids;
}

void Film::write_exr(const std::string& file) const {
  ExrWriter writer(file, parts_->full_width, parts_->full_height, parts_->window, parts_->channels, parts_->attributes);
  writer.write(parts_->rows);
  writer.close(parts_->seconds);
  writer.commit();
}

void Film::write_png(const std::string& file, double exposure) const {
  PngWriter writer(file, width(), height());
  const std::vector<float>* rgb[3] = {&channel("R"), &channel("G"), &channel("B")};
  const auto scale = static_cast<float>(std::exp2(exposure));
  const auto columns = static_cast<std::size_t>(width());
  std::vector<std::uint8_t> row(3 * columns);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height()); ++y) {
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] = display_byte((*rgb[i % 3])[y * columns + i / 3], scale);
    writer.write_row(row.data());
  }
  writer.close();
  writer.commit();
}

} // namespace pointgi::api
