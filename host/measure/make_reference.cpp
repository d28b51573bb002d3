#include "host/measure/make_reference.h"
#include "host/image/exr_writer.h"
#include "host/output_folder.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace pointgi {

namespace {

constexpr int shortest_side_measured = 160, longest_side_measured = 320;

/// Of each half: fewer leave the errors of good settings in the reference's noise.
constexpr int samples_wanted = 512;
/// More would be finer than any setting.
constexpr int most_samples = 8192;

const char* const half_names[] = {"reference-1.exr", "reference-2.exr"};

/// Sums of pictures, each weighted by its samples.
class Half {
public:
  void add(const Picture& picture, int samples) {
    if (samples_ == 0) {
      picture_ = picture;
      picture_.channels.clear();
    }
    samples_ += samples;
    for (const char* colour : Reference::colours) {
      const std::vector<float>& values = picture.channels.at(colour);
      std::vector<double>& sum = sums_[colour];
      sum.resize(values.size());
      for (std::size_t i = 0; i < values.size(); ++i)
        sum[i] += static_cast<double>(samples) * values[i];
    }
  }
  int samples() const { return samples_; }
  Picture mean() const {
    Picture mean = picture_;
    for (const auto& [colour, sum] : sums_) {
      std::vector<float>& values = mean.channels[colour];
      for (const double s : sum)
        values.push_back(static_cast<float>(s / samples_));
    }
    return mean;
  }

private:
  Picture picture_;
  std::map<std::string, std::vector<double>> sums_;
  int samples_ = 0;
};

void write_half(const Picture& half, const std::string& path) {
  Band rows{0, half.height, half.width, {}};
  std::vector<ChannelName> channels;
  for (const auto& [name, values] : half.channels) {
    channels.push_back({name, false});
    rows.values.push_back(values);
  }
  ExrWriter writer(path, half.full_width, half.full_height, half.window, channels, {});
  writer.write(rows);
  writer.close(0.0);
  writer.commit();
}

bool has_colours(const Picture& picture) {
  return std::all_of(std::begin(Reference::colours), std::end(Reference::colours),
                     [&](const char* colour) { return picture.channels.count(colour) == 1; });
}

} // namespace

std::pair<int, int> size_to_measure(int width, int height, double seconds_a_sample, double seconds) {
  const int longest = std::max(width, height);
  const double affordable = std::sqrt(seconds / (2.0 * samples_wanted * std::max(seconds_a_sample, 1e-9)));
  const double side =
      std::clamp(shortest_side_measured * affordable, double{shortest_side_measured}, double{longest_side_measured});
  const double scale = std::min(1.0, side / longest);
  const auto scaled = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
  return {scaled(width), scaled(height)};
}

MadeReference trace_reference(PictureMaker& maker, double seconds, const std::function<unsigned(unsigned)>& seed,
                              const std::function<double()>& elapsed, const RunControl& run) {
  const double begun = elapsed();
  Half halves[2];
  MadeReference made;
  double pace = 0.0; // of a sample of both halves
  unsigned pictures = 0;
  try {
    for (int samples = 1; samples > 0;) {
      const double before = elapsed();
      for (Half& half : halves) {
        const MadePicture traced = maker.trace(samples, seed(pictures++), run);
        if (made.shown.channels.empty()) made.shown = traced.picture;
        half.add(traced.picture, samples);
      }
      pace = std::max(1e-6, (elapsed() - before) / samples);
      // Small steps: the pace of the first is that of building kernels, and an interruption loses one of them.
      const double left = seconds - (elapsed() - begun);
      const int most = std::min(4 * samples, most_samples - halves[0].samples());
      samples = std::min(most, static_cast<int>(std::max(left, 0.0) / pace));
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::interrupted || halves[1].samples() == 0) throw;
  }
  made.first = halves[0].mean();
  made.second = halves[1].mean();
  made.source = halves[0].samples() == halves[1].samples()
                    ? fmt::format("path tracer, twice {} samples a pixel", halves[0].samples())
                    : fmt::format("path tracer, {} and {} samples a pixel", halves[0].samples(), halves[1].samples());
  made.seconds = elapsed() - begun;
  return made;
}

MadeReference read_reference(const std::string& path, const std::optional<std::pair<int, int>>& size) {
  MadeReference made;
  made.first = read_exr(path);
  made.shown = made.first;
  const Picture& p = made.first;
  if (!has_colours(p))
    throw Error(ErrorKind::input,
                path + ": has no channels R, G and B; give a picture that pointgi render has written");
  if (p.width != p.full_width || p.height != p.full_height)
    throw Error(ErrorKind::input,
                fmt::format("{}: holds a part of its picture, {}x{} of {}x{} pixels; render it without --pixelbounds",
                            path, p.width, p.height, p.full_width, p.full_height));
  if (size && (p.width != size->first || p.height != size->second))
    throw Error(ErrorKind::input,
                fmt::format("{}: is {}x{} pixels in size, and {}x{} are measured; leave out --size, "
                            "or render the reference with --size {}x{}",
                            path, p.width, p.height, size->first, size->second, size->first, size->second));
  made.source = path;
  return made;
}

std::optional<MadeReference> kept_reference(const std::string& folder, int width, int height) {
  MadeReference made;
  std::error_code ignored;
  for (Picture* half : {&made.first, &made.second}) {
    const std::string path = file_in(folder, half_names[half == &made.first ? 0 : 1]);
    if (!std::filesystem::exists(path, ignored)) return std::nullopt;
    *half = read_exr(path);
    if (!has_colours(*half) || half->width != width || half->height != height) return std::nullopt;
  }
  made.shown = made.first;
  return made;
}

void keep_reference(const MadeReference& made, const std::string& folder) {
  write_half(made.first, file_in(folder, half_names[0]));
  write_half(made.second, file_in(folder, half_names[1]));
}

} // namespace pointgi
