#pragma once
#include "host/cl/session.h"
#include "host/radiosity/radiosity_map.h"
#include "host/run.h"

namespace pointgi {

/// Progress of a stage, and an end on request, both at every launch of the device.
class StageWatch {
public:
  explicit StageWatch(Session& session) : session_(session) {
    session_.before_launches([this] {
      stop_if_asked();
      report_progress(done_);
    });
  }
  ~StageWatch() { session_.before_launches({}); }
  StageWatch(const StageWatch&) = delete;
  StageWatch& operator=(const StageWatch&) = delete;

  WorkReport report() {
    return [this](const std::string& done) { done_ = done; };
  }

private:
  Session& session_;
  std::string done_ = "at work";
};

} // namespace pointgi
