/* The surface that splats stand for, and what a form of it gives to those who walk through the octree
 * (kernels/traverse):
 *   FOR_MEETINGS, FOR_HITS_OF_BLOCK      where a ray meets a splat, or a block of them: meeting.cl, disc_lanes.cl
 *   normal_at_hit                        the surface's normal there: meeting.cl
 *   is_clipped_off, unclipped_lanes      where a splat ends before its rim: clip.cl, disc_lanes.cl
 *   belongs_to_origin, belongs_to_ends   which hits are the surfaces at a ray's own ends: own_surface.cl,
 *                                        own_surface_lanes.cl
 *   is_back, rim_ray, hides_rim          which backs of splats are no part of the surface: rims.cl
 *   blend_begin, blend_add, blend_end    from the splats met near the first one to the surface there: blend.cl
 * Nothing here traces a ray. The form is that of discs, disc.cl and disc_lanes.cl, or, where HAS_MLS, that of patches of the
 * moving-least-squares surface, mls.cl and mls_lanes.cl. */
#include "surface/blend.cl"
#include "surface/clip.cl"
#include "surface/disc.cl"
#include "surface/meeting.cl"
#include "surface/own_surface.cl"
#include "surface/rims.cl"
