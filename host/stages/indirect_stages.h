#pragma once
/// The stages of indirect light, between the octree and the picture: which the scene needs, and what they found.
#include "host/lights/shaft_light.h"
#include "host/radiosity/plan.h"
#include "host/scene/frame.h"
#include "host/stages/stages.h"
#include <functional>
#include <optional>

namespace pointgi {

/// Light at the points of the pool, [points x 3, W/m² divided by the lighting's scale]; empty where no surface sends
/// any.
struct IndirectLight {
  std::vector<float> from_surfaces; ///< H(B)
  std::vector<float> direct;        ///< from lights; from splats that shine, too, unless they take part in the exchange
  std::vector<float> sky;           ///< of it, from the environment, as the method tells it; empty: not known apart
  Solution solution;
  std::uint64_t rays = 0; ///< that decided which points see each other
  std::vector<MethodStatistic> statistics;
  const RadiosityMethod* method = nullptr;     ///< that solved it, or would
  std::vector<float> entered;                  ///< all irradiance that surfaces passed on besides from_surfaces, where
                                               ///< it is not `direct` alone
  std::optional<DeviceCones> at_pixels;        ///< by which pixels gather from_surfaces themselves; absent: they do not
  std::unique_ptr<PreparedRadiosity> prepared; ///< by which it was solved, for light that enters besides
  std::function<std::unique_ptr<PreparedRadiosity>()> prepare; ///< makes that where an earlier run has solved it
};

/// The scene as the stages before have left it.
struct IndirectRequest {
  const TraversalVariant& variant;
  const Scene& scene;
  const Frame& frame;
  const DeviceLighting& lighting;
  View<Splat> points;    ///< of the pool
  bool by_paths = false; ///< a path tracer makes the picture
  View<float> caustic{}; ///< [points x 3] as IndirectLight: irradiance that photons bring and that surfaces pass
                         ///< on; empty: none
  /// Called after each pass of a method that has passes, with the light so far; may be empty.
  std::function<void(unsigned pass, const IndirectLight& so_far)> after_pass{};
  const ShaftLight* shafts = nullptr; ///< what shaft_light_of() has found
};

/// What light is exchanged in. `exchanging`: exchanging_materials(); must live as long, as must the others.
ExchangeScene exchange_scene(const DevicePools& pools, const IndirectRequest& request, View<std::uint8_t> exchanging);

/// The stage `shafts`: where lamps and [[light]]s need no shadow rays, and what rays tell of them elsewhere. Absent,
/// and skipped with the reason, where nothing asks for it.
std::optional<ShaftLight> shaft_light_of(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                         StageLog& stages);

/// Direct light that pictures take from the points, as the device reads it (kernels/lib/pools.cl).
struct StoredDirect {
  Buffer<cl_float4> texels;
  bool sky = false; ///< that of the environment is in it
};

/// Absent where nothing of it is known at the points, or where the points' irradiance holds all of it.
std::optional<StoredDirect> upload_direct(Session& session, const IndirectRequest& request, const IndirectLight& light);

/// Irradiance of the points [points x 3] by lamps and [[light]]s, the mean of `samples` estimates where shafts do not
/// know it; with_emitters: by splats that shine, too.
std::vector<float> light_of_sources(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                    bool with_emitters, unsigned samples);
/// The same by the environment.
std::vector<float> light_of_sky(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                unsigned samples);
/// a + b, of one size.
std::vector<float> sum_of(std::vector<float> a, View<float> b);
/// Whether the method tells what the environment adds, and rays need not.
bool tells_sky(const RadiosityMethod& method, const IndirectRequest& request);

/// What the stage `plan` finds: the method, and on the way to it what that method will need.
struct ExchangePlan {
  MethodPlan choice;
  RadiosityMap clusters;           ///< of the points that exchange light
  std::vector<float> sources, sky; ///< of IndirectLight::direct, where it was found on the way; else empty
};

/// The stage `plan`: which method suits a scene that leaves the method open. Throws as run_indirect_stages.
ExchangePlan plan_exchange(Session& session, const ExchangeScene& exchange, const IndirectRequest& request,
                           StageLog& stages);

/// Estimates of the direct light of each point that enters the exchange.
unsigned direct_light_samples(const IndirectRequest& request, bool with_emitters);

/// Runs `plan` where the scene leaves the method open, `vmap`, and the stage of the method, which has the method's
/// name, where the scene needs them, and says of each stage that does not run why. Where a checkpoint has the light,
/// it is that. All three and the request must outlive finish_exchange(). Throws Error(interrupted) when the run
/// (host/run.h) is to stop.
IndirectLight run_indirect_stages(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                  StageLog& stages);

/// The stage of the method once more, by what the first run has prepared, for light that enters besides: what surfaces
/// make of `entering` ([points x 3] as IndirectLight, irradiance) is added to `light`, of which run_indirect_stages has
/// found the rest, and returned. `share`, of its power in what entered first, tells how accurate it has to be. Throws
/// as run_indirect_stages.
std::vector<float> add_exchange(Session& session, const IndirectRequest& request, View<float> entering, double share,
                                IndirectLight& light, StageLog& stages);

/// No more light will enter: keeps what pixels need of the method, and lets go of the rest.
void finish_exchange(const IndirectRequest& request, IndirectLight& light);

/// Of each material, whether its splats send and receive diffuse light.
std::vector<std::uint8_t> exchanging_materials(const Scene& scene);

/// Whether some splat reflects light diffusely.
bool has_reflectors(const Scene& scene, View<Splat> points);

/// Whether direct light comes with the points' irradiance, as coarse as its splats (the thesis' way, method.md §6).
bool direct_light_by_radiosity(const Scene& scene);

/// The irradiance that the picture interpolates: from surfaces, where pixels do not gather it themselves, and the
/// direct light where it comes that way.
Buffer<cl_float4> upload_irradiance(Session& session, const IndirectLight& light, const Scene& scene);

/// IndirectLight::direct where no stage of these has found it, because no surface sends any light to another.
std::vector<float> direct_light_of_points(Session& session, const DevicePools& pools, const IndirectRequest& request);

/// [points], 0 to 1: the share of the sky that the front of each point sees, whose directions count by their cosine to
/// the normal; whatever lights the scene has. Mean of `samples` rays a point.
std::vector<float> sky_of_points(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                 unsigned samples);

/// rho times the sum of irradiances: what each point reflects to all sides, [points x 3] as IndirectLight; 0 of points
/// that do not exchange light. Irradiances: [points x 3] each, or empty for none.
std::vector<float> reflected_radiosity(const IndirectRequest& request, const std::vector<View<float>>& irradiances);

/// Power that leaves the points by their radiosity [points x 3], all colours.
double power_of(View<float> radiosity, View<Splat> points);

/// pi L_e: radiosity that each point shines with, [points x 3] as IndirectLight.
std::vector<float> emitted_radiosity(const DeviceLighting& lighting, View<Splat> points);

/// Why light is not exchanged, in a few words; empty when it is: the scene has light, and surfaces that send each
/// other some of it.
std::string reason_against_radiosity(const IndirectRequest& request);

/// The normal field of the specular and glossy splats, as the device takes it (kernels/lib/pools.cl): the stage
/// `normals`; absent where there are none, and the stage is skipped. So it is where splats are `patches`, whose kernels
/// take a field and read none.
std::optional<Buffer<cl_float4>> normal_field_of(Session& session, const DeviceLighting& lighting, View<Splat> points,
                                                 bool patches, StageLog& stages);

/// Refuses settings of [radiosity] that do not go together, before the work. Throws Error(input).
void require_possible_radiosity(const Scene& scene);

} // namespace pointgi
