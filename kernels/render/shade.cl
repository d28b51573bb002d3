/* The picture: light by shadow rays, radiosity and photons (kernels/render/eye_sample.cl, kernels/render/specular_sample.cl). */
#define ADAPTIVE_SAMPLES
#include "render/eye_sample.cl"
#include "render/specular_sample.cl"
#include "render/adaptive.cl"
#define PIXEL_KERNEL shade_pixels
#define ADD_SAMPLE add_sample
#include "render/pixels.cl"
