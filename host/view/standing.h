#pragma once
/// How a model stands.
#include "host/view/up.h"

namespace pointgi {

/// What a model touches the ground with, with one direction upwards.
struct Support {
  double footprint = 0.0; ///< bounding rectangle of the lowest fiftieth, as a share of the whole's; 0 where the middle
                          ///< of the points is not above it
  double filled = 0.0;    ///< share of that rectangle that something is above: 1 of a slab, little of feet or a rim
  double flat = 0.0;      ///< area there that faces down, as a share of the whole's rectangle
};
Support support_of(const ViewPoints& points, int axis, double sign);

/// How unlike one another the two directions across the axis are: 0 for what is turned about it.
double asymmetry_about(const ViewPoints& points, int axis);

/// y or z, whichever axis the model stands along more broadly, feet before slabs; else that which it is symmetric
/// about; else y. Upwards, unless it has no foot there and a broad flat one at the other end: what is wider above, a
/// goblet or a tree, does not stand on its head.
UpChoice standing_up(const ViewPoints& points);

} // namespace pointgi
