#include "host/photon/trace_photons.h"
#include "host/cl/batches.h"
#include "host/cloud/normal_field.h"
#include "host/passes/visibility.h"
#include "host/photon/diffuse_photons.h"
#include "host/photon/kept_photons.h"
#include <algorithm>

namespace pointgi {

namespace {

/// Photons of the first launch, of which nothing is known yet.
constexpr std::size_t first_batch = 1u << 12;

/// Room for `count` flights: for as many as a later launch may have, so that what is held does not depend on how long
/// launches take, or where the device refuses that, for these alone.
Buffer<PhotonFlight> room_for(Session& session, std::size_t count, std::size_t most) {
  try {
    return session.allocate<PhotonFlight>(most);
  } catch (const ResourceError&) {
    return session.allocate<PhotonFlight>(count);
  }
}

void add(const float power[3], std::array<double, 3>& to) {
  for (std::size_t c = 0; c < 3; ++c)
    to[c] += double{power[c]};
}

Photon stored_photon(const PhotonFlight& flight) {
  Photon photon{};
  std::copy_n(flight.position, 3, photon.position);
  photon.inward = flight.inward;
  for (int c = 0; c < 3; ++c)
    photon.power[c] = flight.power[c] * flight.radiance_factor;
  photon.splat = flight.splat;
  return photon;
}

/// Enters a photon that has ended.
void add_to_ledger(const PhotonFlight& flight, std::uint32_t number, PhotonLedger& ledger, KeptPhotons& kept) {
  ++ledger.aimed;
  if (flight.end == PHOTON_MISSED) return;
  ++ledger.emitted;
  add(flight.emitted, ledger.emitted_power);
  add(flight.absorbed, ledger.absorbed_power);
  switch (flight.end) {
  case PHOTON_STORED:
    ++ledger.stored;
    add(flight.power, ledger.stored_power);
    kept.add(stored_photon(flight), number);
    break;
  case PHOTON_ABSORBED:
    ++ledger.absorbed;
    add(flight.power, ledger.absorbed_power);
    break;
  case PHOTON_ESCAPED:
    ++ledger.escaped;
    add(flight.power, ledger.escaped_power);
    break;
  default:
    ++ledger.cut;
    add(flight.power, ledger.cut_power);
  }
}

/// Of the light that a splat receives, on both sides together where it has two, about how much goes on by mirror or
/// lobe.
double passed_on(const Material& material) {
  if ((material.flags & MATERIAL_SPECULAR) == 0) return 0.0;
  if ((material.flags & MATERIAL_TRANSMITS) != 0) return 2.0;
  return double{*std::max_element(material.specular, material.specular + 3)};
}

auto is_specular(const DeviceLighting& lighting) {
  return [&lighting](const Splat& s) {
    return (lighting.materials[static_cast<std::size_t>(s.material)].flags & MATERIAL_SPECULAR) != 0;
  };
}

} // namespace

void add(const PhotonLedger& ledger, PhotonLedger& to) {
  for (const auto member : {&PhotonLedger::aimed, &PhotonLedger::emitted, &PhotonLedger::stored,
                            &PhotonLedger::absorbed, &PhotonLedger::escaped, &PhotonLedger::cut, &PhotonLedger::kept})
    to.*member += ledger.*member;
  for (const auto member : {&PhotonLedger::emitted_power, &PhotonLedger::stored_power, &PhotonLedger::absorbed_power,
                            &PhotonLedger::escaped_power, &PhotonLedger::cut_power})
    for (std::size_t c = 0; c < 3; ++c)
      (to.*member)[c] += (ledger.*member)[c];
  to.device_seconds += ledger.device_seconds;
}

TracedPhotons trace_photons(Session& session, const DevicePools& pools, const PhotonRequest& request,
                            const FlightControl& control) {
  TracedPhotons traced;
  if (request.plan.photons == 0) return traced;
  DeviceFlight flight(session, pools, request);
  Pace pace = request.batch > 0 ? Pace(static_cast<double>(request.batch), request.batch, request.batch)
                                : Pace(first_batch, busy_work_items(session.info()), most_photon_flights);
  Buffer<PhotonFlight> flights;
  KeptPhotons kept(control.most_stored, request.lighting.params.seed);
  const auto launch = [&](std::size_t first, std::size_t count) {
    if (flights.size < count) {
      flights = {};
      flights = room_for(session, count, std::min(pace.most(), flight.photons()));
    }
    const double seconds = flight.launch(flights, first, count);
    traced.ledger.device_seconds += seconds;
    auto number = static_cast<std::uint32_t>(first);
    for (const PhotonFlight& ended : session.download(flights, count))
      add_to_ledger(ended, number++, traced.ledger, kept);
    return seconds;
  };
  if (for_each_batch(EqualItems{flight.photons()}, pace, {control.stop, control.progress}, launch) < flight.photons()) {
    traced.stopped = true;
    return traced;
  }
  traced.one_of = kept.one_of();
  traced.stored = kept.take();
  traced.ledger.kept = traced.stored.size();
  return traced;
}

PhotonSources photon_sources(const DeviceLighting& lighting, View<Splat> points) {
  PhotonSources sources;
  sources.light_sources = lighting.light_sources;
  sources.emitters = lighting.emitters;
  for (const Emitter& emitter : lighting.emitters) {
    const float* e = lighting.materials[static_cast<std::size_t>(points[emitter.point].material)].emission;
    sources.radiance.push_back({e[0], e[1], e[2], 0.0f});
  }
  std::copy_n(lighting.params.environment, 3, sources.environment.begin());
  return sources;
}

std::string reason_against_photons(const DeviceLighting& lighting, const CausticSettings& settings) {
  if (!lighting.has_specular()) return "no specular material";
  if (!lighting.has_light()) return "the scene has no light and no emission";
  if (settings.photons == 0) return "caustics.photons = 0";
  return {};
}

AimedPhotons aim_photons(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                         const DeviceLighting& lighting, const PhotonSources& sources, View<Splat> points,
                         const CausticSettings& settings, double side) {
  AimedPhotons aimed;
  const bool equal_power = settings.power == "equal";
  aimed.start = equal_power ? PhotonStart::equal_power : PhotonStart::aimed;
  const std::size_t lights = sources.light_sources.size() + 2;
  aimed.leaves = specular_leaves(points, is_specular(lighting), most_photon_pairs / lights, equal_power);
  const auto ask = [&](View<Splat> table, View<Segment> segments) {
    const auto step_delta = static_cast<float>(variant.step_delta / side);
    return DeviceVisibility(session, pools, variant, table, step_delta).blocked(segments);
  };
  EmissionOptions options;
  options.photons = static_cast<std::uint64_t>(settings.photons);
  options.equal_power = equal_power;
  options.seed = lighting.params.seed;
  aimed.plan = plan_emission(aimed.leaves, points, sources, ask, options);
  return aimed;
}

std::vector<cl_float4> normal_field_texels(const DeviceLighting& lighting, View<Splat> points) {
  const auto slopes = fit_normal_field(points, is_specular(lighting));
  std::vector<cl_float4> texels(slopes.size());
  for (std::size_t i = 0; i < slopes.size(); ++i)
    std::copy_n(slopes[i].slope, 4, texels[i].s);
  return texels;
}

TracedPhotons send_photons(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                           const DeviceLighting& lighting, const PhotonSources& sources, View<Splat> points,
                           const Buffer<cl_float4>& normal_field, const CausticSettings& settings, double side,
                           const FlightControl& control) {
  const AimedPhotons aimed = aim_photons(session, pools, variant, lighting, sources, points, settings, side);
  return trace_photons(
      session, pools, {lighting, sources, aimed.leaves, aimed.plan, normal_field, variant, side, aimed.start}, control);
}

TracedPhotons send_photons_from_surfaces(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                         const DeviceLighting& lighting, View<float> radiosity, View<Splat> points,
                                         const Buffer<cl_float4>& normal_field, std::uint32_t photons,
                                         std::uint32_t flight, double side, const FlightControl& control) {
  const PhotonSources sources = sources_of_radiosity(radiosity, points, [&](const Splat& s) {
    return passed_on(lighting.materials[static_cast<std::size_t>(s.material)]);
  });
  const SpecularLeaves leaves = specular_leaves(points, is_specular(lighting), 1, false);
  EmissionPlan plan;
  if (photons > 0 && !sources.emitters.empty()) {
    plan.batches.push_back({0, photons, SOURCE_EMITTERS, NO_PHOTON_LEAF, 1.0f / static_cast<float>(photons)});
    plan.photons = photons;
  }
  PhotonRequest request{lighting, sources, leaves, plan, normal_field, variant, side, PhotonStart::from_surfaces};
  request.flight = flight;
  return trace_photons(session, pools, request, control);
}

std::vector<cl_float4> caustic_irradiance(Session& session, const DevicePhotonMap& map,
                                          const std::vector<cl_float4>& places) {
  const Program program = caustic_irradiance_program(map.k);
  cl::Kernel kernel = session.kernel(program.file, program.options, "caustic_irradiance");
  const std::size_t count = places.size() / 2;
  const auto device_places = session.upload(places);
  const auto irradiance = session.allocate<cl_float4>(count);
  session.launch(kernel, LaunchShape::line(count), map.nodes, map.buckets, map.params, device_places, irradiance,
                 static_cast<cl_uint>(count));
  return session.download(irradiance, count);
}

} // namespace pointgi
