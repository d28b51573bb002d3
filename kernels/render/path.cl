/* The picture by path tracing (kernels/render/path_sample.cl); with the paths LE and LDE alone the picture is bit-identical to
 * shade_pixels'. A work-item follows its path to the end: paths of a group end at different bounces, which CPU devices do
 * not mind. */
#include "render/path_sample.cl"
#include "render/specular_path_sample.cl"
#define PIXEL_KERNEL path_pixels
#define ADD_SAMPLE add_path
#include "render/pixels.cl"
