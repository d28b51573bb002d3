#include "host/cloud/readers/field_plan.h"
#include "host/cloud/input_file.h"
#include <algorithm>
#include <initializer_list>
#include <unordered_map>

namespace pointgi {

namespace {

using Names = std::vector<const char*>;
using Places = std::unordered_map<std::string, std::size_t>; ///< lookup name -> index of the field

/// The first field of a name wins; what is called exactly so comes before what only has scalar_ in front of it.
Places places_of(const std::vector<FieldInfo>& fields) {
  Places places;
  for (std::size_t f = 0; f < fields.size(); ++f)
    if (lookup_name(fields[f].name).size() == fields[f].name.size()) places.emplace(lookup_name(fields[f].name), f);
  for (std::size_t f = 0; f < fields.size(); ++f)
    places.emplace(lookup_name(fields[f].name), f);
  return places;
}

/// The first of the `candidates` whose names are all there gets the places from `slot` on.
bool assign(std::initializer_list<Names> candidates, int slot, const Places& places, std::vector<int>& slots) {
  for (const Names& names : candidates) {
    const bool complete =
        std::all_of(names.begin(), names.end(), [&](const char* name) { return places.count(name) != 0; });
    if (!complete) continue;
    for (std::size_t k = 0; k < names.size(); ++k)
      slots[places.at(names[k])] = slot + static_cast<int>(k);
    return true;
  }
  return false;
}

void require_position(const Places& places, const std::string& file, const std::string& place) {
  for (const char* axis : {"x", "y", "z"})
    if (places.count(axis) == 0)
      throw Error(ErrorKind::input,
                  file + ": " + place + " has no property \"" + axis + "\"; expected x, y and z (single numbers)");
}

void choose_kept(const ReadRequest& request, const Places& places, FieldPlan& plan) {
  std::vector<bool> keep(plan.fields.size(), request.all_fields);
  for (const std::string& name : request.fields)
    if (const auto place = places.find(lookup_name(name)); place != places.end()) keep[place->second] = true;
  if (plan.is_grey()) {
    const auto intensity = std::find(plan.slot.begin(), plan.slot.end(), static_cast<int>(slot_intensity));
    keep[static_cast<std::size_t>(intensity - plan.slot.begin())] = true;
  }
  for (std::size_t f = 0; f < keep.size(); ++f)
    if (keep[f]) plan.kept.push_back(f);
}

bool is_kept(const FieldPlan& plan, std::size_t field) {
  return std::binary_search(plan.kept.begin(), plan.kept.end(), field);
}

} // namespace

const std::vector<const char*>& intensity_names() {
  static const std::vector<const char*> names{"intensity", "intensities", "reflectance", "reflectivity", "amplitude"};
  return names;
}

bool FieldPlan::has(int place) const {
  return std::find(slot.begin(), slot.end(), place) != slot.end();
}

bool FieldPlan::is_read(std::size_t field) const {
  return (slot[field] != slot_none && slot[field] != slot_intensity) || is_kept(*this, field);
}

bool FieldPlan::is_grey() const {
  return has(slot_intensity) && !has(slot_colour) && !has(slot_packed_colour) && !has(slot_harmonic);
}

void FieldPlan::forget(int place) {
  std::replace(slot.begin(), slot.end(), place, static_cast<int>(slot_none));
}

const char* FieldPlan::use_of(std::size_t field) const {
  const int place = slot[field];
  if (place == slot_intensity && is_grey()) return "colour (grey)";
  if (place == slot_none || place == slot_intensity) return is_kept(*this, field) ? "kept" : "not used";
  if (place < slot_normal) return "position";
  if (place < slot_colour) return "normal";
  if (place < slot_radius || place == slot_packed_colour) return "colour";
  if (place == slot_radius) return "radius";
  if (place == slot_station) return "scanner position";
  if (place < slot_opacity) return "colour (of a Gaussian)";
  return place == slot_opacity ? "opacity" : place < slot_rotation ? "size" : "rotation";
}

FieldPlan match_fields(std::vector<FieldInfo> fields, const ReadRequest& request, const std::string& file,
                       const std::string& place) {
  FieldPlan plan;
  plan.fields = std::move(fields);
  plan.slot.assign(plan.fields.size(), slot_none);
  const Places places = places_of(plan.fields);
  require_position(places, file, place);
  const auto match = [&](int slot, std::initializer_list<Names> candidates) {
    return assign(candidates, slot, places, plan.slot);
  };
  match(slot_position, {{"x", "y", "z"}});
  match(slot_normal, {{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}, {"normalx", "normaly", "normalz"}});
  const bool colours = match(slot_colour, {{"red", "green", "blue"},
                                           {"r", "g", "b"},
                                           {"diffuse_red", "diffuse_green", "diffuse_blue"},
                                           {"rf", "gf", "bf"}});
  if (!colours) match(slot_packed_colour, {{"rgb"}, {"rgba"}});
  match(slot_radius, {{"radius"}});
  for (const char* name : intensity_names())
    if (match(slot_intensity, {{name}})) break;
  match(slot_station, {{"station"}});
  if (match(slot_harmonic, {{"f_dc_0", "f_dc_1", "f_dc_2"}})) { // without these the others are something else
    match(slot_opacity, {{"opacity"}});
    match(slot_scale, {{"scale_0", "scale_1", "scale_2"}, {"scale_0", "scale_1"}});
    match(slot_rotation, {{"rot_0", "rot_1", "rot_2", "rot_3"}});
  }
  choose_kept(request, places, plan);
  return plan;
}

void report_fields(const FieldPlan& plan, CloudReport& report) {
  constexpr std::size_t most = 8; // a sentence that can be read
  std::string unused;
  std::size_t count = 0;
  for (std::size_t f = 0; f < plan.fields.size(); ++f) {
    const std::string& name = plan.fields[f].name;
    report.fields.push_back(name);
    // Understood, but of no use to opaque diffuse surfaces: alpha, and how colours change with the view.
    const std::string lookup = lookup_name(name);
    const bool understood =
        lookup == "alpha" || lookup == "diffuse_alpha" || (plan.has(slot_harmonic) && lookup.rfind("f_rest_", 0) == 0);
    if (understood || std::string(plan.use_of(f)) != "not used") continue;
    if (count++ < most) unused += (unused.empty() ? "" : ", ") + printable(name);
  }
  if (count > most) unused += " and " + std::to_string(count - most) + " more";
  if (count > 0)
    report.notes.push_back("of the fields of each point these are not used: " + unused +
                           "; a material shows one by albedo = { field = \"NAME\" }");
}

FieldPlan plan_fields(std::vector<FieldInfo> fields, const ReadRequest& request, const std::string& file,
                      const std::string& place, CloudReport& report) {
  FieldPlan plan = match_fields(std::move(fields), request, file, place);
  for (std::size_t f = 0; f < plan.fields.size(); ++f)
    report.properties.push_back(
        {printable(plan.fields[f].name) + " (" + name_of(plan.fields[f].type) + ")", plan.use_of(f)});
  report_fields(plan, report);
  return plan;
}

} // namespace pointgi
