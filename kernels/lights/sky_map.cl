/* Light of the surroundings as a latitude-longitude map, constant on each of its texels: radiance in a direction, and directions
 * drawn with a density that goes as the luminance (host/lights/environment_map.h). */
#include "lib/sampling.cl"
#include "shared/sky_types.h"

typedef struct Sky {
  __constant SkyMap* map;
  const __global SkyRow* rows;     /* height */
  const __global float* columns;   /* height x width: cumulative shares of a row's texels */
  const __global float4* texels;   /* height x width: SkyTexel */
} Sky;

/* The texel in the unit direction: radiance [W/m2/sr, scaled] in xyz, in w the density [1/sr] with which sky_map_sample draws
 * that direction. */
static inline float4 sky_map_towards(Sky sky, float3 direction) {
  const float x = dot3(direction, load3_constant(sky.map->right)), y = dot3(direction, load3_constant(sky.map->forward));
  const float z = dot3(direction, load3_constant(sky.map->up));
  const float column = (atan2(x, y) * 0.15915494f + 0.5f) * (float)sky.map->width;
  const float row = atan2(sqrt(fma(x, x, y * y)), z) * 0.31830989f * (float)sky.map->height;
  const uint i = min((uint)fmax(column, 0.0f), sky.map->width - 1u), j = min((uint)fmax(row, 0.0f), sky.map->height - 1u);
  return sky.texels[j * sky.map->width + i];
}

/* A direction, drawn by four numbers in [0, 1): u.x chooses the row, u.y the column, u.z and u.w the place in the texel. Returns
 * the texel as sky_map_towards does. What is drawn is never black. */
static inline float4 sky_map_sample(Sky sky, float4 u, float3* direction) {
  const uint width = sky.map->width, height = sky.map->height;
  const uint row = pick(&sky.rows->cumulative, sizeof(SkyRow) / sizeof(float), height, u.x);
  const uint column = pick(sky.columns + row * width, 1u, width, u.y);
  const float from_pole = fma(u.w, sky.rows[row].span, sky.rows[row].from_pole);
  const float cosine = 2u * row < height ? 1.0f - from_pole : from_pole - 1.0f;
  const float sine = sqrt(fmax(0.0f, from_pole * (2.0f - from_pole)));
  const float azimuth = 6.2831853f * (((float)column + u.z) / (float)width - 0.5f);
  *direction = normalize3(sine * (sin(azimuth) * load3_constant(sky.map->right) + cos(azimuth) * load3_constant(sky.map->forward)) +
                          cosine * load3_constant(sky.map->up));
  return sky.texels[row * width + column];
}
