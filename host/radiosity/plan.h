#pragma once
/// radiosity.method = "auto": which method suits a scene, known before its visibility is asked for.
#include "host/radiosity/method.h"

namespace pointgi {

struct MethodPlan {
  const RadiosityMethod* method; ///< chosen; nullptr: the light between surfaces is too little to matter
  std::string reason;            ///< in a sentence, for the log and --stats
  LinkEstimate vmap;             ///< what the V-map would ask
};

/// "directions" is taken where the V-map would ask more than this share of its rays: in scans a ray of the V-map, with
/// what its traversal and the fast multipole method take, costs 2.2 to 3.2 of directions, in rooms 1.4, where 512
/// directions have the smaller error. Measured without radiosity.share, by which fewer do: directions are rather taken
/// late. bench_methods measures both at equal error (docs/method/methods.md).
constexpr double dearer_factor = 0.3;

/// Compares what the V-map would ask, from a sample of its questions, with points x settings.directions. Depends on the
/// scene and the settings alone, not on how fast a device is or what is kept from earlier runs. `emitters_exchange`:
/// lamps are among the points that send, which directions would meet too seldom.
MethodPlan plan_method(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                       const RadiosityMap& clusters, bool emitters_exchange);

/// Upper bound of the light that surfaces send each other, as a share of `power`, what they reflect of the direct light
/// [W/m², points x 3 in the tree's order, radiosity], where nothing stood between any two. `albedo`: the largest of all
/// points. Stops where the bound passes `enough`, and returns what it found until then; infinity where it cannot be
/// told in time that grows as the points.
double bound_of_exchange(const ClusterTree& tree, View<float> radiosity, double albedo, double enough);

} // namespace pointgi
