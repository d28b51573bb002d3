#ifndef POINTGI_SHARED_TRAVERSAL_TYPES_H
#define POINTGI_SHARED_TRAVERSAL_TYPES_H
#include "shared/scalar.h"
/* A ray and its answer, for the kernels that trace given rays (kernels/traverse). Root cube units. */

typedef struct RayQuery {
  float origin[3];    /* bytes 0-11 */
  float t_min;        /* bytes 12-15: hits at t <= t_min do not count */
  float direction[3]; /* bytes 16-27: unit */
  float t_max;        /* bytes 28-31: hits at t >= t_max do not count */
} RayQuery;

#define NO_SPLAT 0xffffffffu

typedef struct RayAnswer {
  float t;       /* bytes 0-3: distance of the hit, or t_max */
  pg_uint splat; /* bytes 4-7: index into the point pool, or NO_SPLAT */
} RayAnswer;

#endif
