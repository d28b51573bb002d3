#include "host/app/stats.h"
#include "host/atomic_file.h"
#include "host/available_memory.h"

namespace pointgi {

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

nlohmann::json variant_json(const TraversalVariant& v) {
  return {{"name", name_of(v)},
          {"form", name_of(v.form)},
          {"branching", 1u << v.axis_bits},
          {"order", name_of(v.order)},
          {"leaf_capacity", v.leaf_capacity},
          {"lanes", v.lanes},
          {"storage", name_of(v.storage)},
          {"stepping", name_of(v.stepping)},
          {"grouping", name_of(v.grouping)},
          {"group", name_of(v.group)},
          {"fast_math", v.fast_math},
          {"surface", name_of(v.patches ? SurfaceForm::mls : SurfaceForm::discs)}};
}

namespace {

/// Numbers of photons, and their powers per colour.
nlohmann::json photons_json(const PhotonLedger& l, double watts) {
  const auto power = [&](const std::array<double, 3>& p) {
    return nlohmann::json{p[0] * watts, p[1] * watts, p[2] * watts};
  };
  return {{"aimed", l.aimed},
          {"emitted", l.emitted},
          {"stored", l.stored},
          {"kept", l.kept},
          {"absorbed", l.absorbed},
          {"escaped", l.escaped},
          {"cut", l.cut},
          {"power_w",
           {{"emitted", power(l.emitted_power)},
            {"stored", power(l.stored_power)},
            {"absorbed", power(l.absorbed_power)},
            {"escaped", power(l.escaped_power)},
            {"cut", power(l.cut_power)}}}};
}

void add_radiosity(const IndirectLight& light, const RadiositySettings& settings, nlohmann::json& out) {
  out["radiosity"] = {{"method", light.method->name},
                      {"direct_light", settings.direct_light},
                      {"iterations", light.solution.applies},
                      {"residual", light.solution.residual},
                      {"rays", light.rays},
                      {"converged", light.solution.end == SolveEnd::converged}};
  for (const MethodStatistic& statistic : light.statistics) {
    nlohmann::json& section = out[statistic.section];
    if (section.is_null()) section = nlohmann::json::object();
    section[statistic.name] = statistic.value;
  }
}

void add_render(const Stats& stats, nlohmann::json& out) {
  const RenderTotals& r = stats.render;
  out["render"] = {
      {"integrator", stats.integrator},
      {"rays", r.rays},
      {"eye_rays", r.eye_rays},
      {"mrays_per_s", r.device_seconds > 0.0 ? 1e-6 * static_cast<double>(r.rays) / r.device_seconds : 0.0},
      {"eye_mrays_per_s", r.eye_seconds > 0.0 ? 1e-6 * static_cast<double>(r.eye_rays) / r.eye_seconds : 0.0},
      {"back_face_share", r.back_face_share()},
      {"interrupted", r.interrupted}};
}

} // namespace

void write_stats(const std::string& path, const Stats& stats, const StageLog& stages) {
  using nlohmann::json;
  const DeviceInfo& info = stats.session->info();
  // No null becomes an object by itself: where memory ends there, the library crashes.
  json out = json::object();
  out["version"] = POINTGI_VERSION;
  out["command"] = stats.command;
  out["device"] = {{"name", info.name}, {"vendor", info.vendor}, {"driver", info.driver}, {"opencl", info.opencl}};
  out["scene"] = {{"points", stats.octree.points},
                  {"materials", stats.scene->materials.size()},
                  {"lights", stats.scene->lights.size()}};
  const OctreeSummary& octree = stats.octree;
  out["octree"] = {{"form", octree.form},
                   {"nodes", octree.nodes},
                   {"leaves", octree.leaves},
                   {"depth", octree.depth},
                   {"extra_splats", octree.extra_splats},
                   {"bytes", octree.bytes}};
  out["variant"] = variant_json(stats.variant.variant);
  out["variant"]["source"] = stats.variant.source;
  if (stats.command == "render") add_render(stats, out);
  if (stats.indirect != nullptr && !stats.indirect->from_surfaces.empty())
    add_radiosity(*stats.indirect, stats.scene->radiosity, out);
  if (stats.photons) out["photons"] = photons_json(*stats.photons, stats.photon_watts);
  if (stats.denoised)
    out["denoise"] = {{"library", stats.denoised->file},
                      {"version", stats.denoised->version},
                      {"seconds", stats.denoised->seconds},
                      {"failed", stats.denoised->failure.has_value()}};
  out["stages"] = json::array();
  for (const StageRecord& s : stages.records())
    out["stages"].push_back({{"name", s.name},
                             {"ran", s.ran},
                             {"reason", s.reason},
                             {"seconds", s.seconds},
                             {"device_seconds", s.device_seconds},
                             {"host_peak_bytes", s.host_peak_bytes},
                             {"items", s.items},
                             {"unit", s.unit}});
  out["kernels"] = json::object();
  for (const auto& [name, time] : stats.session->kernel_times())
    out["kernels"][name] = {{"launches", time.launches}, {"seconds", time.seconds}};
  out["programs"] = {{"compiled", stats.session->programs_compiled()},
                     {"from_cache", stats.session->programs_from_cache()},
                     {"kept_by_driver", stats.session->programs_kept_by_driver()}};
  out["memory"] = {{"host_peak_bytes", process_peak_bytes()}, {"device_peak_bytes", stats.session->peak_bytes()}};
  out["seconds"] = stats.seconds;
  write_text(path, out.dump(1) + "\n");
}

} // namespace pointgi
