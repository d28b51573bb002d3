#ifndef POINTGI_SHARED_RENDER_TYPES_H
#define POINTGI_SHARED_RENDER_TYPES_H
#include "shared/light_kinds.h"
#include "shared/material_kinds.h"
#include "shared/octree_types.h"
#include "shared/scalar.h"
/* What the host tells the render kernels of a scene. Lengths are in root cube units; radiometric quantities are divided
 * by one power of two of the host's choosing (RadianceScale), so that lights of 1e-20 or 1e20 W stay inside float. */

/* A pixel has 32 rays, in a grid of GRID_X x GRID_Y (method.md section 6). */
#define GRID_X 8
#define GRID_Y 4
#define GRID_RAYS (GRID_X * GRID_Y)

/* Pinhole camera: the ray through image position (x, y), in pixels from the top left corner of the image, runs from
 * `origin` along corner + x * step_x + y * step_y. */
typedef struct Camera {
  float origin[3]; /* bytes 0-11: root cube; may lie outside it */
  float pad0;
  float corner[3]; /* bytes 16-27 */
  float pad1;
  float step_x[3]; /* bytes 32-43: to the next pixel to the right */
  float pad2;
  float step_y[3]; /* bytes 48-59: to the next pixel downwards */
  float pad3;
} Camera;

/* Classes of light paths as an automaton that reads a path's surfaces, D or S each, from the eye on. It starts in state
 * 0. */
#define PATH_STATES 128
#define PATH_AFTER_D(state) ((state)&255u)          /* bits 0-7: the state after a diffuse surface */
#define PATH_AFTER_S(state) (((state) >> 8) & 255u) /* bits 8-15: after a specular one */
#define PATH_COUNTS 0x10000u                        /* bit 16: paths whose next point is the light count */
#define PATH_GOES_ON 0x20000u                       /* bit 17: some longer path that begins like this counts */

typedef struct RenderParams {
  Camera camera;         /* bytes 0-63 */
  float environment[3];  /* bytes 64-75: radiance from every direction, of a map the mean, scaled */
  pg_uint most_bounces;  /* bytes 76-79: no path has more surface points; or NO_BOUNCE_LIMIT. For the path tracer, and
                            for what others see by way of specular surfaces */
  pg_uint samples;       /* bytes 80-83: samples a pixel */
  pg_uint seed;          /* bytes 84-87 */
  pg_uint jitter;        /* bytes 88-91: 0: samples at the centres of their strata */
  pg_uint light_sources; /* bytes 92-95: number of point and directional lights */
  pg_uint emitters;      /* bytes 96-99: number of emitting splats */
  float step_delta;      /* bytes 100-103: the absolute-delta variant's delta, root cube units */
  float emitter_reach; /* bytes 104-107: root cube: how far rays look for emitting splats (kernels/lights/emitter.cl) */
  pg_uint sky_at_points; /* bytes 108-111: 1: the points' stored direct light holds that of the environment */
  pg_uint path_states[PATH_STATES]; /* bytes 112-623: of the path tracer: the classes of paths that count */
  float emitter_low[3];             /* bytes 624-635: root cube: box around the emitting splats */
  float emitter_high[3];            /* bytes 636-647 */
  pg_uint adaptive;                 /* bytes 648-651: 1: of pixels in which nothing changes few samples are shaded */
  pg_uint pad1;
} RenderParams;

#define NO_BOUNCE_LIMIT 0xffffffffu

/* What the 32 eye rays of a pixel meet, in the order of its samples. */
typedef struct EyeHits {
  float t[GRID_RAYS];       /* bytes 0-127: from the ray's start (kernels/render/camera.cl); or infinity */
  pg_uint splat[GRID_RAYS]; /* bytes 128-255: index into the point pool, or NO_SPLAT */
} EyeHits;

/* One [[light]]. */
typedef struct LightSource {
  float vector[3];   /* bytes 0-11: point: position, root cube; others: unit vector towards the light */
  pg_uint type;      /* bytes 12-15: LIGHT_<ID> of shared/light_kinds.h */
  float strength[3]; /* bytes 16-27: point: intensity [W/sr] over the cube's side squared; others: irradiance [W/m2] of
                        a surface that faces the light; scaled */
  float cumulative;  /* bytes 28-31: share of this and all earlier lights in the total, (0,1]; the last is 1 */
  float sine2;       /* bytes 32-35: sine squared of half the angle under which a far light is seen; 0: one direction */
  float pad[3];
} LightSource;

typedef struct Emitter {
  pg_uint point;    /* bytes 0-3: index into the point pool */
  float cumulative; /* bytes 4-7: share of this and all earlier emitters in the emitted power; the last is 1 */
  DiscClip clip;    /* bytes 8-47: zero where the splat has none */
} Emitter;

typedef struct Material {
  float emission[3];   /* bytes 0-11: radiance of the front side, scaled */
  pg_uint type;        /* bytes 12-15: MATERIAL_<ID> of shared/material_kinds.h */
  float specular[3];   /* bytes 16-27: reflectance of the specular part: of a lobe at most, of a complex index of
                          refraction at normal incidence */
  float exponent;      /* bytes 28-31: phong: of the lobe */
  float absorption[3]; /* bytes 32-43: glass: share of light lost, per root cube side (Beer) */
  float ior;           /* bytes 44-47: glass: index of refraction */
  float eta[3];        /* bytes 48-59: conductor: real part of the index of refraction; 0: `specular` at every angle */
  float alpha;         /* bytes 60-63: conductor: width of the GGX distribution of normals; 0: smooth */
  float extinction[3]; /* bytes 64-75: conductor: imaginary part of the index of refraction */
  pg_uint flags;       /* bytes 76-79: MATERIAL_... of shared/material_kinds.h */
  float emitter_density; /* bytes 80-83: of light sampling on its splats, per root cube side squared; 0: not sampled */
  float pad[3];
} Material;

/* One pixel of the film, FILM_CHANNELS scalars. Radiances are scaled means over the pixel's samples; Z, N, P and albedo
 * are means over the samples that hit a splat. */
#define FILM_DIRECT 0     /* 3: emission, environment and direct light: LE, LDE */
#define FILM_COVERAGE 3   /* share of samples that hit a splat */
#define FILM_ALBEDO 4     /* 3 */
#define FILM_DEPTH 7      /* distance from the camera plane, root cube units */
#define FILM_NORMAL 8     /* 3 */
#define FILM_POSITION 11  /* 3: root cube */
#define FILM_BACK_FACE 14 /* share of samples that met a back face */
#define FILM_RAYS 15      /* rays traced for the pixel, eye and shadow */
#define FILM_DIFFUSE 16   /* 3: light from surface to surface: LDD+E */
#define FILM_SUMS 19      /* channels above are sums over samples; below not */
#define FILM_POINT 19     /* as_float(index into the point pool) of the first sample that hit, or FILM_NO_POINT */
#define FILM_SPREAD 20    /* 3: sum over the samples of (radiance - mean)^2, scaled */
#define FILM_CHANNELS 23
#define FILM_SPECULAR 23 /* 3: only where the scene has specular surfaces: all that the eye sees by way of them */
#define FILM_CHANNELS_SPECULAR 26
#define FILM_CAUSTIC 26 /* 3: only where photons are gathered too: LS+DE */
#define FILM_CHANNELS_CAUSTIC 29
#define FILM_NO_POINT 0xffffffffu

/* Only where a denoiser is to be guided, behind all others: sums over the samples (kernels/render/auxiliary.cl). */
#define AUXILIARY_ALBEDO 0   /* 3: of the first diffuse or rough surface, followed through mirrors and glass */
#define AUXILIARY_NORMAL 3   /* 3: its normal */
#define AUXILIARY_EMISSION 6 /* 3: the part of FILM_DIRECT that no surface has reflected: LE */
#define AUXILIARY_CHANNELS 9

#endif
