#ifndef POINTGI_SHARED_MATERIAL_KINDS_H
#define POINTGI_SHARED_MATERIAL_KINDS_H
/* The kinds of material, a row each: ROW(ID, name). MATERIAL_<ID> is the number of the kind.
 * kernels/materials/<name>.cl scatters rays; host/materials/<name>.cpp reads the keys of the scene file. Both sides
 * take their tables from here. */
#define MATERIAL_KINDS(ROW)                                                                                            \
  ROW(DIFFUSE, diffuse)                                                                                                \
  ROW(MIRROR, mirror)                                                                                                  \
  ROW(GLASS, glass)                                                                                                    \
  ROW(PHONG, phong)                                                                                                    \
  ROW(CONDUCTOR, conductor)

#define MATERIAL_KIND_NUMBER(ID, name) MATERIAL_##ID,
enum MaterialKindNumber { MATERIAL_KINDS(MATERIAL_KIND_NUMBER) MATERIAL_KIND_COUNT };

/* What a material does, whatever its kind (Material::flags). */
#define MATERIAL_REFLECTS_DIFFUSELY 1u /* takes part in the exchange of diffuse light */
#define MATERIAL_SPECULAR 2u           /* rays go on from it: mirrored, refracted, or by a lobe */
#define MATERIAL_HAS_LOBE 4u           /* the specular part is spread, so that sampled lights reach it */
#define MATERIAL_TRANSMITS 8u          /* lets light through; what its backs show is the inside of the body */
#define MATERIAL_TWO_SIDED 16u         /* a splat stands for a thin sheet, whose two sides reflect and emit alike */
#endif
