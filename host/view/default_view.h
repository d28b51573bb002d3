#pragma once
#include "host/scene/splats.h"

namespace pointgi {

/// A view that was found, and what it tells about the light that suits it.
struct ChosenView {
  CloudKind kind = CloudKind::model;
  Vector3d up{0, 1, 0};
  bool is_closed_room = false; ///< there is a ceiling: light from outside stays outside
  bool is_open = false;        ///< a scan of one side
  std::string sentence;        ///< what was chosen, for the log
};

/// Chooses a camera that shows the splats well, and with it whether backs are seen through, where the scene leaves that
/// open. Models, foliage and sparse points: the front at three quarters, slightly above; an open scan from the side
/// that was scanned; a depth frame from its sensor; terrain and maps from the south, 35 degrees down; a station's scan
/// from behind and above the station; rooms from outside, near walls seen through. The splats fill the frame, strays
/// left out. Up is the scene's where it says so, else the file's, else found (host/view/up.h).
ChosenView choose_camera(Scene& scene, const WorldSplats& splats);

/// What there is to say of a view that the scene has. Around a bare cloud (`bare`) up and whether backs are seen
/// through are chosen as by choose_camera(), where neither camera nor scene says so: a camera that was copied from the
/// log gives the same picture.
ChosenView given_view(Scene& scene, const WorldSplats& splats, bool bare);

} // namespace pointgi
