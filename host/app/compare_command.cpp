#include "host/app/commands.h"
#include "host/image/difference.h"
#include "host/json_number.h"
#include <cstdio>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

using nlohmann::json;

json json_of(const Difference& d) {
  return {{"mean_a", json_number(d.mean_a)},   {"mean_b", json_number(d.mean_b)}, {"mse", json_number(d.mse)},
          {"rel_mse", json_number(d.rel_mse)}, {"bias", json_number(d.bias)},     {"p99", json_number(d.p99)},
          {"ssim", json_number(d.ssim)}};
}

void print_json(const CompareOptions& options, const PictureDifference& d) {
  json out = json::object();
  out["a"] = options.first;
  out["b"] = options.second;
  out["area"] = {d.area.x0, d.area.x1, d.area.y0, d.area.y1};
  out["pixels"] = d.pixels;
  out["not_finite"] = d.not_finite;
  out["eps"] = d.eps;
  out["white"] = d.white;
  out["all"] = json_of(d.all);
  for (std::size_t k = 0; k < 3; ++k)
    out[std::string(1, "RGB"[k])] = json_of(d.channel[k]);
  std::printf("%s\n", out.dump(1).c_str());
}

void print_row(const char* name, const Difference& d) {
  std::printf("%-4s %12.5g %12.5g %12.5g %12.5g %+11.4f%% %12.5g %10.6f\n", name, d.mean_a, d.mean_b, d.mse, d.rel_mse,
              100.0 * d.bias, d.p99, d.ssim);
}

void print_table(const PictureDifference& d) {
  std::printf("%-4s %12s %12s %12s %12s %12s %12s %10s\n", "", "mean A", "mean B", "MSE", "relMSE", "bias", "p99 |A-B|",
              "SSIM");
  for (std::size_t k = 0; k < 3; ++k)
    print_row(std::string(1, "RGB"[k]).c_str(), d.channel[k]);
  print_row("all", d.all);
  std::printf("%zu pixels, x from %d to %d, y from %d to %d (ends exclusive); relMSE: (A-B)^2 / (B^2 + %.4g); SSIM of "
              "sRGB values, 1 being a radiance of %.4g\n",
              d.pixels, d.area.x0, d.area.x1, d.area.y0, d.area.y1, d.eps, d.white);
}

} // namespace

ExitCode run_compare(const CompareOptions& options) {
  const Picture a = read_exr(options.first), b = read_exr(options.second);
  const PictureDifference d = difference(a, options.first, b, options.second);
  if (a.full_width != b.full_width || a.full_height != b.full_height)
    spdlog::warn("the pictures are {}x{} and {}x{} in size; compared is their common area, from the upper left corner",
                 a.full_width, a.full_height, b.full_width, b.full_height);
  if (d.not_finite > 0) spdlog::warn("{} pixels hold a NaN or an infinity and were left out", d.not_finite);
  if (d.pixels == 0)
    throw Error(ErrorKind::input,
                options.first + " and " + options.second +
                    ": no pixel is finite in both, so there is nothing to compare; render them again");
  if (options.json)
    print_json(options, d);
  else
    print_table(d);
  return ExitCode::done;
}

} // namespace pointgi
