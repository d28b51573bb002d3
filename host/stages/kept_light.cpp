#include "host/stages/kept_light.h"
#include <algorithm>

namespace pointgi {

namespace {

void pack_solution(Packer& to, const Solution& s) {
  to << s.end << s.residual << s.rate << s.settling << s.applies << s.sweeps << s.krylov_steps << s.history;
}

void unpack_solution(Unpacker& from, Solution& s) {
  from >> s.end >> s.residual >> s.rate >> s.settling >> s.applies >> s.sweeps >> s.krylov_steps >> s.history;
}

} // namespace

void pack(Packer& to, const ShaftLight& light) {
  to << light.irradiance << light.change << light.known << std::uint64_t{light.known_points};
}

void unpack(Unpacker& from, ShaftLight& light) {
  std::uint64_t known_points = 0;
  from >> light.irradiance >> light.change >> light.known >> known_points;
  light.known_points = known_points;
}

void pack(Packer& to, const IndirectLight& light) {
  const auto& methods = radiosity_methods();
  // One behind the last: none.
  const auto method =
      static_cast<std::uint32_t>(std::find(methods.begin(), methods.end(), light.method) - methods.begin());
  to << method << light.from_surfaces << light.direct << light.sky << light.rays;
  pack_solution(to, light.solution);
  to << static_cast<std::uint64_t>(light.statistics.size());
  for (const MethodStatistic& statistic : light.statistics)
    to << statistic.section << statistic.name << statistic.value;
}

void unpack(Unpacker& from, IndirectLight& light) {
  const auto& methods = radiosity_methods();
  auto method = static_cast<std::uint32_t>(methods.size());
  from >> method >> light.from_surfaces >> light.direct >> light.sky >> light.rays;
  unpack_solution(from, light.solution);
  std::uint64_t statistics = 0;
  from >> statistics;
  for (std::uint64_t i = 0; i < statistics && from.is_good(); ++i) {
    MethodStatistic& statistic = light.statistics.emplace_back();
    from >> statistic.section >> statistic.name >> statistic.value;
  }
  light.method = method < methods.size() ? methods[method] : nullptr;
}

void pack(Packer& to, const AddedExchange& added) {
  to << added.field.irradiance << added.rays;
  pack_solution(to, added.field.solution);
}

void unpack(Unpacker& from, AddedExchange& added) {
  from >> added.field.irradiance >> added.rays;
  unpack_solution(from, added.field.solution);
}

void pack(Packer& to, const TracedPhotons& traced) {
  to << traced.stored << traced.one_of << traced.ledger;
}

void unpack(Unpacker& from, TracedPhotons& traced) {
  from >> traced.stored >> traced.one_of >> traced.ledger;
}

} // namespace pointgi
