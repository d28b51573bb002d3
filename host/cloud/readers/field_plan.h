#pragma once
/// What the fields of a file mean to us, by their names: one list for every format that names its fields.
#include "host/cloud/readers/readers.h"

namespace pointgi {

/// Places in a row of values. A triple's other two follow its first.
enum Slot : int {
  slot_none = -1,
  slot_position = 0,
  slot_normal = 3,
  slot_colour = 6,
  slot_radius = 9,
  slot_packed_colour = 10, ///< 0x00RRGGBB, as an integer or in the bits of a float
  slot_intensity = 11,
  slot_station = 12,  ///< index of a scanner position
  slot_harmonic = 13, ///< f_dc_0..2 of a 3D Gaussian: colour = 0.5 + 0.28209479 f
  slot_opacity = 16,  ///< its logit
  slot_scale = 17,    ///< natural logarithms of its axes; of flat ones two
  slot_rotation = 20, ///< its quaternion w x y z
  slot_count = 24
};

struct FieldPlan {
  std::vector<FieldInfo> fields;         ///< of the file, in its order
  std::vector<int> slot;                 ///< Slot of each, slot_none for what is not used
  std::vector<std::size_t> kept;         ///< indices of the fields that go to PointCloud::fields
  bool has(int place) const;             ///< whether some field has this place
  bool is_read(std::size_t field) const; ///< whether its values go anywhere; a reader may pass anything for others

  /// Whether intensity stands in for colours, of which there are none.
  bool is_grey() const;
  /// Takes its place from a field that the file gives no sense to.
  void forget(int place);
  /// For `pointgi info`: "position", "normal", "kept", "not used" ...
  const char* use_of(std::size_t field) const;
};

/// Matches names (case does not count; scalar_ as CloudCompare writes it is left out of account): x y z; nx normal_x
/// normalx …; red r diffuse_red scalar_R …; rgb rgba; radius; intensity …; f_dc_0 … rot_3. Where several names could be
/// one thing the first of the list wins. Intensity is kept where there are no colours: it stands in for them.
/// Throws Error(input) "<file>: <place> has no property …" where x, y or z is missing; `place`: where the fields are
/// declared, "line 3: element vertex".
FieldPlan match_fields(std::vector<FieldInfo> fields, const ReadRequest& request, const std::string& file,
                       const std::string& place);

/// Under what names a file may have the strength of the return, the likeliest first.
const std::vector<const char*>& intensity_names();

/// Writes the names of all fields to `report.fields`, and those that are not used to `report.notes`.
void report_fields(const FieldPlan& plan, CloudReport& report);

/// match_fields() and report_fields(), and the use of every field to `report.properties`.
FieldPlan plan_fields(std::vector<FieldInfo> fields, const ReadRequest& request, const std::string& file,
                      const std::string& place, CloudReport& report);

} // namespace pointgi
