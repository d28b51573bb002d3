#include "tests/bench/embree_peer.h"
#include <chrono>
#include <cstring>

namespace pointgi::bench {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RTCRay embree_ray(const RayQuery& q) {
  RTCRay ray{};
  ray.org_x = q.origin[0], ray.org_y = q.origin[1], ray.org_z = q.origin[2];
  ray.dir_x = q.direction[0], ray.dir_y = q.direction[1], ray.dir_z = q.direction[2];
  ray.tnear = q.t_min;
  ray.tfar = q.t_max;
  ray.mask = ~0u;
  return ray;
}

} // namespace

EmbreePeer::EmbreePeer(const std::vector<Splat>& splats) {
  device_ = rtcNewDevice("threads=2,start_threads=1");
  const auto start = std::chrono::steady_clock::now();
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                             4 * sizeof(float), splats.size()));
  auto* normal = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), splats.size()));
  for (std::size_t i = 0; i < splats.size(); ++i) {
    std::memcpy(vertex + 4 * i, splats[i].position, 3 * sizeof(float));
    vertex[4 * i + 3] = splats[i].radius;
    std::memcpy(normal + 3 * i, splats[i].normal, 3 * sizeof(float));
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  build_seconds_ = seconds_since(start);
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

double EmbreePeer::closest_single(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const {
  const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit hit{};
    hit.ray = embree_ray(rays[i]);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &hit);
    answers[i] = {hit.ray.tfar, hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? NO_SPLAT : hit.hit.primID};
  }
  return seconds_since(start);
}

double EmbreePeer::closest_packet16(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const {
  const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t block = 0; block < rays.size() / 16; ++block) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit16 hit{};
    alignas(64) int valid[16];
    for (int k = 0; k < 16; ++k) {
      const RayQuery& q = rays[16 * block + static_cast<std::size_t>(k)];
      valid[k] = -1;
      hit.ray.org_x[k] = q.origin[0], hit.ray.org_y[k] = q.origin[1], hit.ray.org_z[k] = q.origin[2];
      hit.ray.dir_x[k] = q.direction[0], hit.ray.dir_y[k] = q.direction[1], hit.ray.dir_z[k] = q.direction[2];
      hit.ray.tnear[k] = q.t_min, hit.ray.tfar[k] = q.t_max, hit.ray.mask[k] = ~0u;
      hit.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, scene_, &context, &hit);
    for (int k = 0; k < 16; ++k)
      answers[16 * block + static_cast<std::size_t>(k)] = {
          hit.ray.tfar[k], hit.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? NO_SPLAT : hit.hit.primID[k]};
  }
  return seconds_since(start);
}

double EmbreePeer::any_single(const std::vector<RayQuery>& rays) const {
  const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = embree_ray(rays[i]);
    rtcOccluded1(scene_, &context, &ray);
  }
  return seconds_since(start);
}

} // namespace pointgi::bench
