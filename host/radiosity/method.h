#pragma once
/// Light that diffuse surfaces send each other, solved once for all views (method.md §3, §4): what a method of solving
/// it is. A method is a folder of kernels/radiosity, a file here, and a row of methods.cpp.
#include "fmm/solve/solve.h"
#include "host/passes/device_cones.h"
#include "host/passes/device_pools.h"
#include "host/radiosity/radiosity_map.h"
#include "host/scene/lighting.h"
#include "host/scene/radiosity_words.h"
#include <memory>

namespace pointgi {

/// Light that enters the exchange, of all points of the pool; W/m² divided by the lighting's scale.
struct EnteringLight {
  View<float> direct; ///< [points x 3]: irradiance by lights (point_irradiance.h)
  View<float>
      emitted; ///< [points x 3]: radiosity that they shine with themselves; empty: none, or in `direct` of others
};

/// The solution, per point of the pool.
struct RadiosityField {
  std::vector<float> irradiance; ///< [points x 3, W/m² divided by the lighting's scale]: from surfaces to surfaces,
                                 ///< LDD+; 0 of points that do not exchange light
  Solution solution; ///< radiosity of those that do, in the method's own order of the points, where that is kept, and
                     ///< its residual
};

/// A whole number that --stats writes under `section`.
struct MethodStatistic {
  std::string section; ///< "radiosity" or "vmap"
  std::string name;
  std::uint64_t value = 0;
};

/// Told after each pass of a method that has passes, from 1 on: the irradiance so far, RadiosityField::irradiance.
using PassWatch = std::function<void(unsigned pass, const std::vector<float>& irradiance)>;

/// What a method has found out of a scene before it knows any light: kept, and solved for as much light as enters.
class PreparedRadiosity {
public:
  virtual ~PreparedRadiosity() = default;
  PreparedRadiosity() = default;
  PreparedRadiosity(const PreparedRadiosity&) = delete;
  PreparedRadiosity& operator=(const PreparedRadiosity&) = delete;

  /// Solves B = E + rho (H_direct + H(B)) to a residual of `tolerance` and gathers H(B) once more. The same light gives
  /// the same bits, whatever was solved before. Throws std::invalid_argument on sizes that differ, Error(device),
  /// Error(memory).
  virtual RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) = 0;

  /// What pixels gather the light between surfaces with (radiosity.at = "pixels") when these radiosities leave the
  /// surfaces: `radiosity` [points x 3] as EnteringLight. Absent of methods of which pixels interpolate the points'
  /// irradiance, and where nothing exchanges light. Nothing may be solved for after that.
  virtual std::optional<DeviceCones> cones_of(View<float>) { return std::nullopt; }

  /// [points of the pool x 3, W/m² divided by the lighting's scale]: irradiance from the environment, where the method
  /// finds that on its way (RadiosityMethod::tells_sky); 0 of points that exchange no light. Else empty.
  virtual std::vector<float> sky(const DeviceLighting&) { return {}; }

  /// Rays that decided who sees whom until now, or in an earlier run. Solving traces only what a method does not keep.
  virtual std::uint64_t rays() const = 0;
  /// What it works with, for the log: "12345 links".
  virtual std::string summary() const = 0;
  /// What --stats writes besides what all methods have.
  virtual std::vector<MethodStatistic> statistics() const = 0;

  PassWatch after_pass; ///< called while solving, where RadiosityMethod::has_passes; may be empty
};

struct RadiosityMethod {
  const char* name;         ///< word of radiosity.method and of --stats, folder of kernels/radiosity, stage
  const char* without_vmap; ///< nullptr: it needs the V-map; else why not, which --stats says of the stage `vmap`
  bool is_linear; ///< the solution of a sum of lights is the sum of theirs, to the method's own error: light that
                  ///< enters later may be solved by itself
  /// `map`: of map_visibility(); absent where the method needs none. Session, pools and the scene's points must outlive
  /// what is returned.
  /// Throws Error(device), Error(memory).
  std::unique_ptr<PreparedRadiosity> (*prepare)(Session& session, const ExchangeScene& scene,
                                                const RadiositySettings& settings, std::optional<RadiosityMap> map,
                                                const WorkReport& report);
  bool has_passes = false; ///< the light is there a bounce at a time, and can be looked at after each
  bool tells_sky = false;  ///< PreparedRadiosity::sky() is known
  bool has_cones = false;  ///< pixels may gather by PreparedRadiosity::cones_of(), with radiosity.at = "pixels"
};

/// All methods; the first is the one that needs a V-map.
const std::vector<const RadiosityMethod*>& radiosity_methods();

/// The method of this name; nullptr of "auto", "none" and words that are no method's.
const RadiosityMethod* radiosity_method(const std::string& name);

} // namespace pointgi
