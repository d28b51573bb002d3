#include "host/app/profile_report.h"
#include "host/app/stats.h"
#include "host/repeats.h"
#include "host/tune/tuned.h"
#include <algorithm>
#include <cstdio>

namespace pointgi {

namespace {

constexpr const char* bytes_defined =
    "bytes a second: the least that a launch must move, rays read, answers written and each byte of the pools read "
    "once, over its seconds; what caches save or repeat is not in it";
constexpr const char* before_its_turn = "interrupted before their turn";
constexpr const char* ties_defined =
    "ties: rays that find another splat at exactly the same distance, which trees of another order may; of photons, "
    "those that meet such a splat and therefore miss their target in one of the two trees";
constexpr const char* order_defined =
    "sorted by the picture's speed: the reference's seconds for the same rows over the variant's, median of the rounds";

const KernelProfile& kernel_of(const VariantProfile& v, ProfiledKernel kernel) {
  return v.kernels[static_cast<std::size_t>(kernel)];
}

double a_second(std::uint64_t count, const KernelProfile& k) {
  const double seconds = median_of_repeats(k.seconds);
  return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

std::string number(double value, const char* format = "%.2f") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// What the kernel answers about, in words.
std::string answers_of(ProfiledKernel kernel) {
  const bool rays = kernel != ProfiledKernel::segments && kernel != ProfiledKernel::photons;
  return name_of(kernel) + std::string(rays ? " rays" : "");
}

/// Why a variant is not in the ranking; empty when it is.
std::string excluded(const VariantProfile& v) {
  if (!v.failure.empty()) return "failed: " + v.failure;
  if (v.wrong()) {
    std::string text = "WRONG:";
    for (std::size_t k = 0; k < profiled_kernels; ++k)
      if (v.kernels[k].wrong > 0)
        text += " " + std::to_string(v.kernels[k].wrong) +
                (static_cast<ProfiledKernel>(k) == ProfiledKernel::render
                     ? " of the picture's eye rays and pixels differ,"
                     : " of " + std::to_string(v.kernels[k].rays) + " " + answers_of(static_cast<ProfiledKernel>(k)) +
                           " differ,");
    text.back() = ' ';
    return text + "from the reference";
  }
  return v.complete() ? "" : before_its_turn;
}

std::string remarks(const VariantProfile& v) {
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  if (name_of(v.variant) == name_of(reference_variant())) add("reference");
  if (v.variant.fast_math) {
    std::size_t differ = 0;
    for (const KernelProfile& k : v.kernels)
      differ += k.wrong;
    add("approximate, " + std::to_string(differ) + " answers differ");
  }
  std::size_t ties = 0;
  for (const KernelProfile& k : v.kernels)
    ties += k.ties;
  if (ties > 0) add(std::to_string(ties) + " ties");
  return text;
}

using Row = std::vector<std::string>;

const Row& heads() {
  static const Row row{"",        "variant", "x ref",    "spread",  "render Mrays/s", "GB/s",   "eye Mrays/s",
                       "bounced", "any",     "segments", "photons", "pools MiB",      "remarks"};
  return row;
}

/// Launches a second, as fast as the machine was over the whole run: the reference's median, times how much faster the
/// variant was than the reference beside it. A machine that was busy in between does not change the order.
double rated(const VariantProfile& v, const VariantProfile& reference, ProfiledKernel kernel) {
  const double seconds = median_of_repeats(kernel_of(reference, kernel).seconds);
  return seconds > 0.0 ? v.speedup(kernel) / seconds : 0.0;
}

Row row_of(const VariantProfile& v, const VariantProfile& reference, std::size_t rank) {
  const KernelProfile& render = kernel_of(v, ProfiledKernel::render);
  const auto mrays = [&](ProfiledKernel kernel) {
    if (kernel_of(v, kernel).skipped) return std::string("-");
    return number(1e-6 * rated(v, reference, kernel) * static_cast<double>(kernel_of(v, kernel).rays));
  };
  const auto [least, most] = std::minmax_element(render.speedup.begin(), render.speedup.end());
  return {std::to_string(rank),
          name_of(v.variant),
          number(v.speedup()),
          number(*least) + "-" + number(*most),
          mrays(ProfiledKernel::render),
          number(1e-9 * rated(v, reference, ProfiledKernel::render) * static_cast<double>(render.bytes)),
          mrays(ProfiledKernel::eye),
          mrays(ProfiledKernel::bounced),
          mrays(ProfiledKernel::any),
          mrays(ProfiledKernel::segments),
          mrays(ProfiledKernel::photons),
          number(static_cast<double>(v.pool_bytes) / 1048576.0, "%.1f"),
          remarks(v)};
}

std::vector<Row> rows_of(const Profile& profile) {
  std::vector<Row> rows;
  for (const std::size_t i : profile.ranking())
    rows.push_back(row_of(profile.variants[i], profile.variants.front(), rows.size() + 1));
  return rows;
}

/// Those that are not ranked, a line each.
std::vector<std::string> rest_of(const ProfileReport& report) {
  std::vector<std::string> lines;
  std::size_t never = 0;
  for (const VariantProfile& v : report.profile.variants) {
    const std::string why = excluded(v);
    never += why == before_its_turn;
    if (!why.empty() && why != before_its_turn) lines.push_back(name_of(v.variant) + ": " + why);
  }
  if (never > 0) lines.push_back(std::to_string(never) + " variants were not measured: " + before_its_turn);
  for (const TraversalVariant& v : report.invalid)
    lines.push_back(name_of(v) + ": not valid here: " + why_not(v, report.device));
  return lines;
}

/// What the scene had nothing for; empty where it had work for all kernels.
std::string skipped_text(const Profile& profile) {
  return profile.without_photons.empty() ? "" : "photons: not measured: " + profile.without_photons;
}

std::string conclusion(const ProfileReport& report) {
  const VariantProfile* winner = report.profile.winner();
  if (winner == nullptr) return "no variant was measured to the end\n";
  const std::string best =
      "best: " + name_of(winner->variant) + ", " + number(winner->speedup()) + " times the reference\n";
  return best + (report.stored.empty()
                     ? "not stored: " + report.not_stored + "\n"
                     : "stored for this device in " + report.stored + "; render uses it from now on\n");
}

std::string summary(const ProfileReport& report) {
  const Profile& p = report.profile;
  return report.scene + ", " + std::to_string(report.splats) + " splats; " + report.device.name + " (" +
         report.device.platform + ", driver " + report.device.driver + "); " + std::to_string(report.rounds) +
         " rounds, seed " + std::to_string(report.seed) + "; " + std::to_string(p.proved_rays) +
         " rays of the reference proved by a linear scan" + (p.interrupted ? "; interrupted" : "");
}

} // namespace

std::string profile_table(const ProfileReport& report) {
  std::vector<Row> rows = rows_of(report.profile);
  rows.insert(rows.begin(), heads());
  std::vector<std::size_t> width(heads().size(), 0);
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      width[c] = std::max(width[c], row[c].size());
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string blanks(width[c] - row[c].size(), ' ');
      const bool is_text = c == 1 || c + 1 == row.size();
      line += (c > 0 ? "  " : "") + (is_text ? row[c] + blanks : blanks + row[c]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  for (const std::string& line : rest_of(report))
    text += line + "\n";
  if (const std::string skipped = skipped_text(report.profile); !skipped.empty()) text += skipped + "\n";
  return text + "x ref: times the reference's speed, the picture; " + ties_defined + "\n" + conclusion(report);
}

std::string profile_markdown(const ProfileReport& report) {
  const auto line = [](const Row& row) {
    std::string text = "|";
    for (const std::string& cell : row)
      text += " " + cell + " |";
    return text + "\n";
  };
  std::string text =
      "# Variants by speed\n\n" + summary(report) + ".\n\n" + line(heads()) + line(Row(heads().size(), "---"));
  for (const Row& row : rows_of(report.profile))
    text += line(row);
  const std::vector<std::string> rest = rest_of(report);
  if (!rest.empty()) text += "\n## Not ranked\n\n";
  for (const std::string& entry : rest)
    text += "* " + entry + "\n";
  const std::string skipped = skipped_text(report.profile);
  return text + "\n" + conclusion(report) + (skipped.empty() ? "" : "\n* " + skipped) + "\n* " + order_defined +
         "; spread: its least and most\n* " + bytes_defined + "\n* " + ties_defined +
         "\n* eye: nearest hits of coherent rays, 8x4 a pixel; bounced: of cosine rays off random splats; any: whether "
         "these hit anything; segments: whether anything stands between two splats, as the V-map asks; photons: of "
         "the lights, by way of specular surfaces to where they end; render: the picture's middle rows, eye and shadow "
         "rays\n";
}

namespace {

nlohmann::json kernel_json(const KernelProfile& k) {
  nlohmann::json out{
      {"rays", k.rays}, {"bytes", k.bytes}, {"wrong", k.wrong}, {"ties", k.ties}, {"seconds", k.seconds}};
  if (k.seconds.empty()) return out;
  const auto [least, most] = std::minmax_element(k.seconds.begin(), k.seconds.end());
  out["median_seconds"] = median_of_repeats(k.seconds);
  out["min_seconds"] = *least;
  out["max_seconds"] = *most;
  out["times_reference"] = median_of_repeats(k.speedup);
  out["rays_per_s"] = a_second(k.rays, k);
  out["bytes_per_s"] = a_second(k.bytes, k);
  return out;
}

nlohmann::json measured_json(const VariantProfile& v) {
  nlohmann::json out{{"name", name_of(v.variant)},
                     {"variant", variant_json(v.variant)},
                     {"valid", true},
                     {"ranked", excluded(v).empty()},
                     {"reason", excluded(v)},
                     {"wrong", v.wrong()},
                     {"approximate", v.variant.fast_math},
                     {"pool_bytes", v.pool_bytes}};
  for (std::size_t k = 0; k < profiled_kernels; ++k)
    if (!v.kernels[k].skipped) out["kernels"][name_of(static_cast<ProfiledKernel>(k))] = kernel_json(v.kernels[k]);
  return out;
}

} // namespace

nlohmann::json profile_json(const ProfileReport& report, const StageLog& stages) {
  const Profile& p = report.profile;
  const DeviceInfo& d = report.device;
  nlohmann::json out{
      {"version", POINTGI_VERSION},
      {"command", "profile"},
      {"date", today()},
      {"device",
       {{"name", d.name}, {"vendor", d.vendor}, {"platform", d.platform}, {"driver", d.driver}, {"opencl", d.opencl}}},
      {"scene", report.scene},
      {"splats", report.splats},
      {"rounds", report.rounds},
      {"seed", report.seed},
      {"filter", report.filter},
      {"interrupted", p.interrupted},
      {"proved_rays", p.proved_rays},
      {"reference", name_of(reference_variant())},
      {"definitions", {{"order", order_defined}, {"bytes_per_s", bytes_defined}}},
      {"seconds", stages.seconds()}};
  out["skipped"] = nlohmann::json::object();
  if (!p.without_photons.empty()) out["skipped"][name_of(ProfiledKernel::photons)] = p.without_photons;
  const auto window = [](const PixelWindow& w) { return nlohmann::json{w.x0, w.x1, w.y0, w.y1}; };
  out["windows"] = {{"eye", window(p.eye_window)}, {"render", window(p.render_window)}};
  const VariantProfile* winner = p.winner();
  out["winner"] = winner != nullptr ? nlohmann::json(name_of(winner->variant)) : nlohmann::json();
  out["stored"] = report.stored.empty() ? nlohmann::json() : nlohmann::json(report.stored);
  out["variants"] = nlohmann::json::array();
  std::vector<bool> is_ranked(p.variants.size(), false);
  for (const std::size_t i : p.ranking()) {
    out["variants"].push_back(measured_json(p.variants[i]));
    is_ranked[i] = true;
  }
  for (std::size_t i = 0; i < p.variants.size(); ++i)
    if (!is_ranked[i]) out["variants"].push_back(measured_json(p.variants[i]));
  for (const TraversalVariant& v : report.invalid)
    out["variants"].push_back({{"name", name_of(v)},
                               {"variant", variant_json(v)},
                               {"valid", false},
                               {"ranked", false},
                               {"reason", why_not(v, d)}});
  return out;
}

std::string variant_listing(const std::vector<TraversalVariant>& variants, const DeviceInfo& device) {
  std::string text = "what variants need, by number:\n";
  for (std::size_t i = 0; i < preconditions().size(); ++i)
    text += "  " + std::to_string(i + 1) + "  " + preconditions()[i].sentence + "\n";
  text += device.name + " (" + device.platform + "):\n";
  std::size_t valid = 0;
  for (const TraversalVariant& v : variants) {
    std::string needs;
    for (std::size_t i = 0; i < preconditions().size(); ++i)
      if (preconditions()[i].concerns(v)) needs += (needs.empty() ? "" : ",") + std::to_string(i + 1);
    const std::string why = why_not(v, device);
    valid += why.empty();
    char line[160];
    std::snprintf(line, sizeof line, "  %-52s needs %-12s ", name_of(v).c_str(), needs.c_str());
    text += line + (why.empty() ? std::string("valid") : "not here: " + why) + "\n";
  }
  return text + std::to_string(valid) + " of " + std::to_string(variants.size()) + " are valid on this device\n";
}

} // namespace pointgi
