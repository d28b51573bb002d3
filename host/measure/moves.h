#pragma once
/// Settings of several knobs: what becomes of one where a single knob changes.
#include "host/measure/knobs.h"

namespace pointgi {

using Overrides = std::vector<std::string>; ///< sorted: "radiosity.directions=64", as --set takes them

/// radiosity.method of the overrides, or `otherwise`.
std::string method_of(const Overrides& overrides, const std::string& otherwise);

/// The overrides with this value of the knob, whatever they had for its keys before. Where the value asks for another
/// radiosity.method than they have (theirs is `method` where they do not say), what that one alone reads goes; so does,
/// where it is "none", what light between surfaces reads.
Overrides with_value(const Overrides& overrides, const Knob& knob, const KnobValue& value,
                     const std::vector<Knob>& knobs, const std::string& method);

/// Whether the value can be taken beside these overrides: it asks for no method or for theirs, or is one of the methods
/// themselves.
bool goes_with(const Overrides& overrides, const Knob& knob, const KnobValue& value, const std::string& method);

/// The place of the knob's value that the overrides have; of the scene's own where they do not say; absent: another.
std::optional<std::size_t> value_in(const Overrides& overrides, const Knob& knob);

/// The least values of all knobs that are numbers, whose error falls with them and that `method` reads, but for the
/// samples of pixels.
Overrides cheapest(const std::vector<Knob>& knobs, const std::string& method);

/// "cheap_spp-8": names the overrides by what they have besides those of the run `start`, and by the scene's own values
/// that they have instead of these, but for what alone another radiosity.method reads; where the start has none, the
/// scene's own value has no name, or that is shorter, as name_of_overrides. `method`: where they do not say.
std::string name_about(const Overrides& overrides, const Overrides& start, const std::string& start_name,
                       const std::vector<Knob>& knobs, const std::string& method);

/// "directions-32_photons-100000": names the overrides by the last parts of their keys; usable in a file name.
std::string name_of_overrides(const Overrides& overrides);

} // namespace pointgi
