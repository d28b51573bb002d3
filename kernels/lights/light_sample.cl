/* What all kinds of light share. */
#include "lib/sampling.cl"
#include "traverse/traversal.cl"

/* A place or direction from which light may come, and what it adds to the irradiance when nothing is in between. */
typedef struct LightSample {
  float3 towards; /* unit */
  float distance;
  float3 irradiance;
  float3 normal; /* of the emitting disc; 0 where the light is none, as its radius */
  float radius;
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
