#pragma once
/// The photons of a scene text, as the render command sends them.
#include "host/passes/build_pools.h"
#include "host/photon/trace_photons.h"
#include "host/stages/indirect_stages.h"
#include "host/stages/prepare.h"
#include "host/stages/stages.h"
#include "host/tune/variant_list.h"
#include "tests/support/device.h"
#include "tests/support/temporary_folder.h"
#include <fstream>

namespace pointgi::test {

struct PhotonScene {
  Scene scene;
  PlacedSplats placed;
  TraversalVariant variant;
  OctreePools octree;
  DevicePools pools;
  DeviceLighting lighting;
  PhotonSources sources;
  std::optional<Buffer<cl_float4>> field;

  explicit PhotonScene(const std::string& toml, const TraversalVariant& of = plain_variant(TraversalForm::wide))
      : scene(read(toml)), placed(load_and_place(scene, false)), variant(of),
        octree(build_pools(placed.splats, variant)), pools(upload_pools(session(), octree, variant.storage)),
        lighting(device_lighting(scene, placed.frame, points())), sources(photon_sources(lighting, points())) {
    StageLog stages;
    field = normal_field_of(session(), lighting, points(), false, stages);
  }

  View<Splat> points() const { return points_of(octree); }

  TracedPhotons send() const {
    return send({[] { return false; }, {}});
  }
  TracedPhotons send(const FlightControl& control) const {
    return send_photons(session(), pools, variant, lighting, sources, points(), *field, scene.caustics,
                        placed.frame.side, control);
  }

  /// World W of the device's power.
  double watts(double power) const { return power * lighting.radiance.scale * placed.frame.side * placed.frame.side; }

private:
  static Scene read(const std::string& toml) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("scene.toml")) << toml;
    return load_scene(folder.file("scene.toml"));
  }
};

} // namespace pointgi::test
