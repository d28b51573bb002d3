#pragma once
/// What kind of coordinates a LAS file says that it has.
#include "host/cloud/readers/las_header.h"

namespace pointgi {

enum class LasCoordinates {
  unknown,    ///< nothing is said
  projected,  ///< metres or feet of a map
  geographic, ///< degrees of longitude and latitude
  geocentric  ///< metres from the Earth's centre
};

/// By the records LASF_Projection 2112 (text, WKT) and 34735 (GeoKeys), whichever the header says counts, else the
/// other.
LasCoordinates las_coordinates(const InputFile& file, const LasHeader& header);

} // namespace pointgi
