#include "tests/bench/embree_peer.h"
#include <cstring>
#include <omp.h>
#include <pmmintrin.h>
#include <string>

namespace pointgi::bench {

namespace {

RTCRay embree_ray(const RayQuery& q) {
  RTCRay ray{};
  ray.org_x = q.origin[0], ray.org_y = q.origin[1], ray.org_z = q.origin[2];
  ray.dir_x = q.direction[0], ray.dir_y = q.direction[1], ray.dir_z = q.direction[2];
  ray.tnear = q.t_min;
  ray.tfar = q.t_max;
  ray.mask = ~0u;
  return ray;
}

/// What Embree's manual asks for: no denormals, which are slow.
void flush_denormals() {
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

RTCRayHit embree_query(const RayQuery& q) {
  RTCRayHit hit{};
  hit.ray = embree_ray(q);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return hit;
}

RayAnswer answer_of(const RTCRayHit& hit) {
  return {hit.ray.tfar, hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? NO_SPLAT : hit.hit.primID};
}

} // namespace

EmbreePeer::EmbreePeer(const std::vector<Splat>& splats) {
#pragma omp parallel
  flush_denormals();
  device_ = rtcNewDevice(("start_threads=1,threads=" + std::to_string(omp_get_max_threads())).c_str());
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
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreePeer::closest_single(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const {
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit hit = embree_query(rays[i]);
    rtcIntersect1(scene_, &context, &hit);
    answers[i] = answer_of(hit);
  }
}

void EmbreePeer::closest_stream32(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const {
#pragma omp parallel for schedule(dynamic, 32)
  for (std::size_t stream = 0; stream < rays.size() / 32; ++stream) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit hits[32];
    for (std::size_t k = 0; k < 32; ++k)
      hits[k] = embree_query(rays[32 * stream + k]);
    rtcIntersect1M(scene_, &context, hits, 32, sizeof(RTCRayHit));
    for (std::size_t k = 0; k < 32; ++k)
      answers[32 * stream + k] = answer_of(hits[k]);
  }
}

void EmbreePeer::closest_packet16(const std::vector<RayPacketQuery>& packets,
                                  std::vector<RayPacketAnswer>& answers) const {
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t i = 0; i < packets.size(); ++i)
    for (int first = 0; first < PACKET_RAYS; first += 16) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
      RTCRayHit16 hit{};
      alignas(64) int valid[16];
      const RayPacketQuery& q = packets[i];
      for (int k = 0; k < 16; ++k) {
        valid[k] = -1;
        hit.ray.org_x[k] = q.origin[0], hit.ray.org_y[k] = q.origin[1], hit.ray.org_z[k] = q.origin[2];
        hit.ray.dir_x[k] = q.direction[0][first + k], hit.ray.dir_y[k] = q.direction[1][first + k],
        hit.ray.dir_z[k] = q.direction[2][first + k];
        hit.ray.tnear[k] = q.t_min, hit.ray.tfar[k] = q.t_max, hit.ray.mask[k] = ~0u;
        hit.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(valid, scene_, &context, &hit);
      for (int k = 0; k < 16; ++k) {
        answers[i].t[first + k] = hit.ray.tfar[k];
        answers[i].splat[first + k] = hit.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? NO_SPLAT : hit.hit.primID[k];
      }
    }
}

// Embree says that a ray is blocked by a far end of -infinity.
std::size_t EmbreePeer::any_single(const std::vector<RayQuery>& rays) const {
  std::size_t blocked = 0;
#pragma omp parallel for schedule(dynamic, 1024) reduction(+ : blocked)
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = embree_ray(rays[i]);
    rtcOccluded1(scene_, &context, &ray);
    blocked += ray.tfar < 0.0f;
  }
  return blocked;
}

std::size_t EmbreePeer::any_stream32(const std::vector<RayQuery>& rays) const {
  std::size_t blocked = 0;
#pragma omp parallel for schedule(dynamic, 32) reduction(+ : blocked)
  for (std::size_t stream = 0; stream < rays.size() / 32; ++stream) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRay all[32];
    for (std::size_t k = 0; k < 32; ++k)
      all[k] = embree_ray(rays[32 * stream + k]);
    rtcOccluded1M(scene_, &context, all, 32, sizeof(RTCRay));
    for (const RTCRay& ray : all)
      blocked += ray.tfar < 0.0f;
  }
  return blocked;
}

std::size_t EmbreePeer::any_packet16(const std::vector<RayQuery>& rays) const {
  std::size_t blocked = 0;
#pragma omp parallel for schedule(dynamic, 64) reduction(+ : blocked)
  for (std::size_t packet = 0; packet < rays.size() / 16; ++packet) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRay16 all{};
    alignas(64) int valid[16];
    for (std::size_t k = 0; k < 16; ++k) {
      const RayQuery& q = rays[16 * packet + k];
      valid[k] = -1;
      all.org_x[k] = q.origin[0], all.org_y[k] = q.origin[1], all.org_z[k] = q.origin[2];
      all.dir_x[k] = q.direction[0], all.dir_y[k] = q.direction[1], all.dir_z[k] = q.direction[2];
      all.tnear[k] = q.t_min, all.tfar[k] = q.t_max, all.mask[k] = ~0u;
    }
    rtcOccluded16(valid, scene_, &context, &all);
    for (const float end : all.tfar)
      blocked += end < 0.0f;
  }
  return blocked;
}

} // namespace pointgi::bench
