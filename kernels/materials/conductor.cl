/* Metals: a rough or smooth interface to a conductor. Microfacets have the GGX distribution of normals (Walter et al.,
 * "Microfacet Models for Refraction through Rough Surfaces", 2007) with height-correlated Smith masking; directions are
 * drawn by the visible normals (Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018). Light that
 * microfacets pass on to each other is left out: single scattering. */
#include "materials/fresnel.cl"
#include "materials/scatter.cl"

#if WITH_CONDUCTOR
/* Share of unpolarised light of cosine c >= 0 that an interface to a medium of index eta + i k reflects (Born and Wolf,
 * "Principles of Optics", section 14.2). */
static inline float fresnel_conductor(float c, float eta, float k) {
  const float c2 = c * c, s2 = 1.0f - c2, t0 = eta * eta - k * k - s2;
  const float a2b2 = sqrt(t0 * t0 + 4.0f * eta * eta * k * k), a = sqrt(fmax(0.5f * (a2b2 + t0), 0.0f));
  const float across = (a2b2 + c2 - 2.0f * a * c) / (a2b2 + c2 + 2.0f * a * c);
  const float t3 = c2 * a2b2 + s2 * s2, t4 = 2.0f * a * c * s2;
  return 0.5f * across * (1.0f + (t3 - t4) / (t3 + t4));
}

/* Lambda of Smith's masking function, from the cosine with the mean normal. */
static inline float ggx_lambda(float cosine, float alpha) {
  const float c2 = cosine * cosine;
  return 0.5f * (sqrt(1.0f + alpha * alpha * (1.0f - c2) / fmax(c2, 1e-12f)) - 1.0f);
}

/* Density of microfacet normals per solid angle, from the sine squared with the mean normal: 1 - c^2 of a cosine near 1 would
 * have lost its digits. */
static inline float ggx_density(float sine2, float alpha) {
  const float a2 = alpha * alpha, t = sine2 + a2 * (1.0f - sine2);
  return a2 * 0.318309886f / (t * t);
}

/* A normal of the microfacets that are visible from `v`, unit, v.z > 0, in the frame of the mean normal z. */
static inline float3 ggx_visible_normal(float3 v, float alpha, float2 u) {
  const float3 stretched = normalize3((float3)(alpha * v.x, alpha * v.y, v.z));
  const float length2 = stretched.x * stretched.x + stretched.y * stretched.y;
  const float3 t1 = length2 > 1e-12f ? (float3)(-stretched.y, stretched.x, 0.0f) / sqrt(length2) : (float3)(1.0f, 0.0f, 0.0f);
  const float3 t2 = cross(stretched, t1);
  const float r = sqrt(u.x), phi = 6.2831853f * u.y, p1 = r * cos(phi), half_way = 0.5f * (1.0f + stretched.z);
  const float p2 = (1.0f - half_way) * sqrt(fmax(0.0f, 1.0f - p1 * p1)) + half_way * r * sin(phi);
  const float3 n = p1 * t1 + p2 * t2 + sqrt(fmax(0.0f, 1.0f - p1 * p1 - p2 * p2)) * stretched;
  return normalize3((float3)(alpha * n.x, alpha * n.y, fmax(n.z, 1e-6f)));
}

#ifdef HAS_SPECULAR
static inline float3 conductor_reflectance(const __global Material* material, float cosine) {
  if (material->eta[0] == 0.0f)
    return load3(material->specular);
  return (float3)(fresnel_conductor(cosine, material->eta[0], material->extinction[0]),
                  fresnel_conductor(cosine, material->eta[1], material->extinction[1]),
                  fresnel_conductor(cosine, material->eta[2], material->extinction[2]));
}

/* From the front; false where the ray ends. */
static inline bool conductor_sample(const Surface* s, const __global Material* materials, float3 direction, float2 u,
                                    Media* media, Scatter* out) {
  const __global Material* material = materials + s->material;
  const float3 n = facing_normal(s, direction);
  out->back = out->through = false;
  if (material->alpha == 0.0f) {
    out->direction = reflect3(direction, n);
    out->weight = conductor_reflectance(material, -dot3(direction, n));
    out->pdf = 0.0f;
    return s->front;
  }
  float3 a, b;
  tangents(n, &a, &b);
  const float3 v = (float3)(-dot3(direction, a), -dot3(direction, b), -dot3(direction, n));
  const float3 h = ggx_visible_normal(v, material->alpha, u);
  const float cosine = dot3(v, h);
  const float3 l = 2.0f * cosine * h - v;
  const float at_v = 1.0f + ggx_lambda(v.z, material->alpha);
  out->direction = normalize3(l.x * a + l.y * b + l.z * n);
  out->weight = conductor_reflectance(material, cosine) * (at_v / (at_v + ggx_lambda(l.z, material->alpha)));
  out->pdf = ggx_density(h.x * h.x + h.y * h.y, material->alpha) / (at_v * 4.0f * v.z);
  return s->front && l.z > 0.0f;
}

/* f for light from `towards` that leaves against `direction`; *pdf: density with which conductor_sample would have chosen it. */
static inline float3 conductor_eval(const Surface* s, const __global Material* material, float3 direction, float3 towards,
                                    float* pdf) {
  const float3 n = facing_normal(s, direction), h = normalize3(towards - direction), across = cross(n, h);
  const float to_viewer = -dot3(direction, n), to_light = dot3(towards, n), alpha = material->alpha;
  *pdf = 0.0f;
  if (alpha == 0.0f || !(to_light > 0.0f))
    return (float3)(0.0f);
  const float density = ggx_density(dot3(across, across), alpha);
  const float at_v = 1.0f + ggx_lambda(to_viewer, alpha);
  *pdf = density / (at_v * 4.0f * to_viewer);
  return conductor_reflectance(material, dot3(towards, h)) *
         (density / ((at_v + ggx_lambda(to_light, alpha)) * 4.0f * to_viewer * to_light));
}

#ifdef HAS_CONES
/* Normals of width alpha are spread as those of a Phong lobe of exponent 2 / alpha^2 - 2, and mirrored directions by twice
 * their angle: as a lobe of a quarter of it. */
static inline LobeCone conductor_cone(const Surface* s, const __global Material* material, float3 direction) {
  const float3 n = facing_normal(s, direction);
  const float alpha = material->alpha, cosine = -dot3(direction, n), masked = ggx_lambda(cosine, alpha);
  LobeCone cone;
  cone.direction = reflect3(direction, n);
  cone.weight = conductor_reflectance(material, cosine) * ((1.0f + masked) / (1.0f + 2.0f * masked));
  cone.spread = phong_spread(fmax(0.5f / (alpha * alpha) - 0.5f, 0.0f));
  return cone;
}
#endif
#endif
#endif
