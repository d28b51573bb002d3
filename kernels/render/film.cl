/* From the 32 samples of a pixel to its film. */
#include "shared/render_types.h"

/* Sums of a sample: those of the film's first FILM_SUMS channels, then, where there is any, FILM_SPECULAR's three, then
 * FILM_CAUSTIC's. */
#ifdef HAS_SPECULAR
#define SUM_SPECULAR FILM_SUMS
#endif
#ifdef HAS_CAUSTICS /* never without specular surfaces */
#define SUM_CAUSTIC (FILM_SUMS + 3)
#define SAMPLE_SUMS (FILM_SUMS + 6)
#define FILM_STRIDE FILM_CHANNELS_CAUSTIC
#elif defined(HAS_SPECULAR)
#define SAMPLE_SUMS (FILM_SUMS + 3)
#define FILM_STRIDE FILM_CHANNELS_SPECULAR
#else
#define SAMPLE_SUMS FILM_SUMS
#define FILM_STRIDE FILM_CHANNELS
#endif

#ifdef HAS_AUXILIARY /* behind all of these, in the sums and in the film */
enum AuxiliaryPlaces { SUM_AUXILIARY = SAMPLE_SUMS, FILM_AUXILIARY = FILM_STRIDE };
#undef SAMPLE_SUMS
#undef FILM_STRIDE
#define SAMPLE_SUMS (SUM_AUXILIARY + AUXILIARY_CHANNELS)
#define FILM_STRIDE (FILM_AUXILIARY + AUXILIARY_CHANNELS)
#endif

/* What the work-items of one pixel leave for each other. */
typedef struct PixelSamples {
  float sums[SAMPLE_SUMS][GRID_RAYS];
  uint points[GRID_RAYS];
#ifdef ADAPTIVE_SAMPLES
  uint alike[GRID_RAYS]; /* kernels/render/adaptive.cl */
#endif
} PixelSamples;

static inline void keep_sample(const float* sums, uint point, uint lane, __local PixelSamples* samples) {
  for (int c = 0; c < SAMPLE_SUMS; ++c)
    samples->sums[c][lane] = sums[c];
  samples->points[lane] = point;
}

#ifdef ADAPTIVE_SAMPLES
static inline void copy_sample(__local PixelSamples* samples, uint from, uint to) {
  for (int c = 0; c < SAMPLE_SUMS; ++c)
    samples->sums[c][to] = samples->sums[c][from];
  samples->points[to] = samples->points[from];
}
#endif

/* In one order on every device. */
static inline float sum_of(const __local float* of) {
  float sum = 0.0f;
  for (int i = 0; i < GRID_RAYS; ++i)
    sum += of[i];
  return sum;
}

/* All light of one colour that sample i brings. */
static inline float radiance_of(const __local PixelSamples* samples, uint colour, int i) {
  float radiance = samples->sums[FILM_DIRECT + colour][i] + samples->sums[FILM_DIFFUSE + colour][i];
#ifdef HAS_SPECULAR
  radiance += samples->sums[SUM_SPECULAR + colour][i];
#endif
#ifdef HAS_CAUSTICS
  radiance += samples->sums[SUM_CAUSTIC + colour][i];
#endif
  return radiance;
}

/* The film's sum of the same. */
static inline float radiance_of_film(const __global float* pixel, uint colour) {
  float radiance = pixel[FILM_DIRECT + colour] + pixel[FILM_DIFFUSE + colour];
#ifdef HAS_SPECULAR
  radiance += pixel[FILM_SPECULAR + colour];
#endif
#ifdef HAS_CAUSTICS
  radiance += pixel[FILM_CAUSTIC + colour];
#endif
  return radiance;
}

/* Radiance of one colour, and its spread: of this pass about its own mean, then joined with that of the passes before
 * (Chan, Golub and LeVeque, "Updating formulae", 1979). Sums of squares would lose a small spread about a large mean. */
static inline void add_radiance_to_film(const __local PixelSamples* samples, uint colour, float before, float count,
                                        __global float* pixel) {
  float direct = sum_of(samples->sums[FILM_DIRECT + colour]), diffuse = sum_of(samples->sums[FILM_DIFFUSE + colour]);
  float spread = 0.0f, all = direct + diffuse;
#ifdef HAS_SPECULAR
  float specular = sum_of(samples->sums[SUM_SPECULAR + colour]);
  all += specular;
#endif
#ifdef HAS_CAUSTICS
  float caustic = sum_of(samples->sums[SUM_CAUSTIC + colour]);
  all += caustic;
#endif
  const float mean = all / count;
  for (int i = 0; i < (int)count; ++i) {
    const float off = radiance_of(samples, colour, i) - mean;
    spread += off * off;
  }
  if (before > 0.0f) {
    const float mean_before = radiance_of_film(pixel, colour) / before;
    const float apart = mean - mean_before;
    spread += pixel[FILM_SPREAD + colour] + apart * apart * (before * count / (before + count));
    direct += pixel[FILM_DIRECT + colour];
    diffuse += pixel[FILM_DIFFUSE + colour];
#ifdef HAS_SPECULAR
    specular += pixel[FILM_SPECULAR + colour];
#endif
#ifdef HAS_CAUSTICS
    caustic += pixel[FILM_CAUSTIC + colour];
#endif
  }
  pixel[FILM_DIRECT + colour] = direct;
  pixel[FILM_DIFFUSE + colour] = diffuse;
#ifdef HAS_SPECULAR
  pixel[FILM_SPECULAR + colour] = specular;
#endif
#ifdef HAS_CAUSTICS
  pixel[FILM_CAUSTIC + colour] = caustic;
#endif
  pixel[FILM_SPREAD + colour] = spread;
}

/* Adds `count` samples to the film of a pixel that holds `before`; 0: it holds nothing yet. A work-item a channel: each of
 * the pixel's 32 calls this, after a barrier behind keep_sample. */
static inline void add_to_film(const __local PixelSamples* samples, uint lane, uint before, uint count,
                               __global float* pixel) {
  if (lane < 3u) {
    add_radiance_to_film(samples, lane, (float)before, (float)count, pixel);
  } else if (lane < FILM_DIFFUSE) {
    const float sum = sum_of(samples->sums[lane]);
    pixel[lane] = before == 0u ? sum : pixel[lane] + sum;
  } else if (lane == FILM_DIFFUSE) {
    uint first = FILM_NO_POINT;
    for (int i = GRID_RAYS - 1; i >= 0; --i)
      first = samples->points[i] != FILM_NO_POINT ? samples->points[i] : first;
    if (before == 0u || as_uint(pixel[FILM_POINT]) == FILM_NO_POINT)
      pixel[FILM_POINT] = as_float(first);
  }
#ifdef HAS_AUXILIARY
  if (lane > FILM_DIFFUSE && lane <= FILM_DIFFUSE + AUXILIARY_CHANNELS) {
    const uint channel = lane - (FILM_DIFFUSE + 1);
    const float sum = sum_of(samples->sums[SUM_AUXILIARY + channel]);
    pixel[FILM_AUXILIARY + channel] = before == 0u ? sum : pixel[FILM_AUXILIARY + channel] + sum;
  }
#endif
}
