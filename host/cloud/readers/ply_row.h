#pragma once
/// A vertex of a PLY file becomes a row of values, whatever kind of body it comes from.
#include "host/cloud/readers/ply_layout.h"

namespace pointgi {

class PlyRow {
public:
  PlyRow(const PlyElement& vertex, const FieldPlan& plan) : vertex_(vertex) {
    std::size_t field = 0;
    for (const PlyProperty& property : vertex.properties) {
      types_.push_back(property.is_list ? property.type : plan.fields[field].type);
      is_read_.push_back(!property.is_list && plan.is_read(field));
      if (!property.is_list) ++field;
    }
    values_.resize(field);
  }

  /// Takes the values of a record from `body`, which has begun it. In the order of the plan's fields; 0 for those that
  /// nobody reads.
  template <class Body>
  const double* read(Body& body) {
    std::size_t field = 0;
    for (std::size_t p = 0; p < types_.size(); ++p) {
      const PlyProperty& property = vertex_.properties[p];
      if (property.is_list) {
        body.skip(types_[p], body.list_count(property));
      } else {
        if (is_read_[p])
          values_[field] = body.scalar(types_[p]);
        else
          body.skip(types_[p], 1);
        ++field;
      }
    }
    return values_.data();
  }

private:
  const PlyElement& vertex_;
  std::vector<FieldType> types_; ///< as they are read
  std::vector<bool> is_read_;
  std::vector<double> values_;
};

} // namespace pointgi
