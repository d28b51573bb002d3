#include "host/cloud/point_cloud.h"

namespace pointgi {

const char* name_of(CloudKind kind) {
  switch (kind) {
  case CloudKind::model:
    return "model";
  case CloudKind::depth_frame:
    return "depth frame";
  case CloudKind::station:
    return "station scan";
  case CloudKind::terrain:
    return "terrain";
  case CloudKind::room:
    return "room";
  case CloudKind::map:
    return "map";
  case CloudKind::sparse:
    return "sparse points";
  case CloudKind::foliage:
    return "foliage";
  }
  return "";
}

} // namespace pointgi
