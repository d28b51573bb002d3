#ifndef POINTGI_SHARED_LIGHT_KINDS_H
#define POINTGI_SHARED_LIGHT_KINDS_H
/* The kinds of [[light]], a row each: ROW(ID, name). LIGHT_<ID> is the number of the kind. kernels/lights/<name>.cl
 * samples it; host/lights/<name>.cpp reads the keys of the scene file. Both sides take their tables from here. Emitting
 * splats (kernels/lights/emitter.cl) and the environment (kernels/lights/sky.cl) are no [[light]]. */
#define LIGHT_KINDS(ROW)                                                                                               \
  ROW(POINT, point)                                                                                                    \
  ROW(DIRECTIONAL, directional)                                                                                        \
  ROW(SUN, sun)

#define LIGHT_KIND_NUMBER(ID, name) LIGHT_##ID,
enum LightKindNumber { LIGHT_KINDS(LIGHT_KIND_NUMBER) LIGHT_KIND_COUNT };

/* Those that have a size, so that a ray may meet them; their kernel files have <name>_towards, too. */
#define SIZED_LIGHT_KINDS(ROW) ROW(SUN, sun)

#define LIGHT_BIT(ID, name) (1u << LIGHT_##ID) |
#define SIZED_LIGHTS (SIZED_LIGHT_KINDS(LIGHT_BIT) 0u)
/* Up to this many [[light]]s are all sampled for every ray; of more, one, drawn in proportion to its strength. */
#define ALL_LIGHT_SOURCES 4u
#endif
