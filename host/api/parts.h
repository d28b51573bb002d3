#pragma once
/// What the objects of the library are made of; the command line looks in here for what it reports. Not installed.
#include "host/api/film.h"
#include "host/cl/session.h"
#include "host/render/growing_film.h"
#include "host/scene/scene_document.h"
#include "host/stages/light_stages.h"
#include "host/stages/lit_cloud.h"
#include "host/stages/prepared_scene.h"

namespace pointgi::api {

struct Context::Parts {
  Session session;
  StageLog stages; ///< of all that is done with the context
};

struct Scene::Parts {
  SceneDocument document;
  std::string quality = "normal";
  bool quality_of_samples = true;
  bool quality_of_points = false; ///< light is read at the points, not by way of a picture

  /// Checked, of the quality asked for. Throws Error(input).
  pointgi::Scene description() const;
};

struct Prepared::Parts {
  std::shared_ptr<Context::Parts> context;
  std::string quality;
  pointgi::Scene scene; ///< with the camera and the lights that were chosen
  PreparedScene ready;

  View<Splat> points() const { return ready.points; }
};

struct Light::Parts {
  std::shared_ptr<Prepared::Parts> prepared;
  LightOptions options;
  SceneLight light;
  Buffer<cl_float4> irradiance; ///< that pictures interpolate; empty where no surface sends any light
  bool warned_of_dark = false;  ///< the log knows why pictures will be black
  std::vector<float> sky;       ///< of the points; empty: not asked for yet

  IndirectRequest request() const;
  /// Finds direct light where solving did not need it; the log hears why, and where all is dark.
  LitCloud lit_cloud(const LitFileOptions& options);
  /// The stage `sky`, once.
  const std::vector<float>& sky_of_points();
};

/// What Light throws at once for want of memory: before other work is done. Throws Error(memory).
void require_memory(const Prepared& prepared, const LightOptions& options);

/// A film before its rows: what is rendered, and how the file describes it. Throws as Film does.
class FilmJob {
public:
  FilmJob(Light::Parts& light, const FilmOptions& options);
  FilmJob(const FilmJob&) = delete;
  FilmJob& operator=(const FilmJob&) = delete;

  const RenderSettings& settings() const { return view_.render; }
  const PixelWindow& window() const { return request_->window; }
  std::vector<ChannelName> channels() const;
  PictureAttributes attributes() const;

  /// The stage `render`: hands finished bands to `take`; stops when the run does, with the rows that are finished. The
  /// log hears what black or empty pictures come from.
  RenderTotals render(const std::function<void(const Band&)>& take);
  /// A picture that grows pass by pass; no stage is logged for it. Borrows the job.
  GrowingFilm growing() const;
  /// How many samples attributes() tells of; before growing(), or between its growths.
  void set_samples(int samples);

  /// Warnings of the picture that was made.
  void warn(const RenderTotals& totals) const;

private:
  Light::Parts& light_;
  std::string paths_;
  pointgi::Scene view_; ///< the scene, seen as the film sees it
  DeviceLighting lighting_;
  std::optional<RenderRequest> request_;
};

} // namespace pointgi::api
