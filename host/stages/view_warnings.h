#pragma once
/// What black or empty pictures most often come from, said in the log.
#include "host/render/render.h"
#include "host/stages/indirect_stages.h"
#include "host/stages/prepared_scene.h"

namespace pointgi {

/// Warns where none of the light paths that `list` asks the path tracer for can be in this scene, before the work;
/// tells whether it did.
bool warn_of_paths(const std::string& list, const Scene& scene, const PreparedScene& ready);

/// Warns where lights are there, but none of their light reaches any surface, and nothing is specular, so that no other
/// way of light is left; tells whether it did. `direct`: irradiance by lights, `from_surfaces`: by the exchange (may be
/// empty), each [points x 3].
bool warn_of_unlit(const Scene& scene, const PreparedScene& ready, View<float> direct, View<float> from_surfaces);

/// Warns of a PNG that is burnt nearly everywhere, or nearly black though the picture is not; names the exposure, and
/// lamps that are too weak for the size of the scene.
void warn_of_exposure(const PngLight& shown, const Scene& scene, const PreparedScene& ready);

/// Warns of a picture that shows no splat, many backs, or that is black; of the last not where `already_warned`.
void warn_of_view(const RenderTotals& totals, const Scene& scene, const PreparedScene& ready, bool already_warned);

} // namespace pointgi
