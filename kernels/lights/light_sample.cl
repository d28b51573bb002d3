/* What all kinds of light share.
 *   HAS_SKY_MAP  light from all around is a map; else it is the same from every direction */
#include "lib/sampling.cl"
#include "traverse/traversal.cl"
#ifdef HAS_SKY_MAP
#include "lights/sky_map.cl"
#endif

#define INVERSE_PI 0.31830989f

typedef struct Lights {
  __constant RenderParams* params;
  const __global Material* materials;
  const __global LightSource* light_sources;
  const __global Emitter* emitters;
#ifdef HAS_SKY_MAP
  Sky sky;
#endif
} Lights;

/* Kernels take LIGHT_PARAMS and make `Lights` of {LIGHT_ARGS} (host/passes/device_lights.h). */
#define LIGHT_TABLE_PARAMS                                                            \
  __constant RenderParams *params, const __global Material *materials,                \
      const __global LightSource *light_sources, const __global Emitter *emitters
#define LIGHT_TABLE_ARGS params, materials, light_sources, emitters
#ifdef HAS_SKY_MAP
#define LIGHT_PARAMS                                                                                                 \
  LIGHT_TABLE_PARAMS, __constant SkyMap *sky_map, const __global SkyRow *sky_rows, const __global float *sky_columns, \
      const __global float4 *sky_texels
#define LIGHT_ARGS LIGHT_TABLE_ARGS, {sky_map, sky_rows, sky_columns, sky_texels}
#else
#define LIGHT_PARAMS LIGHT_TABLE_PARAMS
#define LIGHT_ARGS LIGHT_TABLE_ARGS
#endif

/* A place or direction from which light may come, and what it adds to the irradiance when nothing is in between. */
typedef struct LightSample {
  float3 towards; /* unit */
  float distance;
  float3 irradiance;
  float3 normal; /* of the emitting disc; 0 where the light is none, as its radius */
  float radius;
  float diffuse_weight; /* of `irradiance` where the surface reflects diffusely: rays by the cosine count the rest */
#ifdef HAS_LOBES
  float pdf; /* of light sampling, per solid angle; 0: no ray that is sent out can meet this light */
#endif
} LightSample;

/* Where photons of a light set out. */
typedef struct PhotonOrigin {
  float3 vector;   /* the place, or of parallel light the unit vector towards the light */
  bool parallel;
  float3 strength; /* intensity from a place; irradiance of what faces parallel light */
} PhotonOrigin;

/* The balance heuristic (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995): weight
 * of a sample that was drawn with density `pdf` and could have been drawn with `other`. */
static inline float mis_weight(float pdf, float other) { return pdf / (pdf + other); }
