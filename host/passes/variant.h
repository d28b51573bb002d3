#pragma once
/// The choices that make a kernel variant, and the one place where -D options are composed.
#include "host/cl/device.h"
#include "host/scene/scene.h"
#include <string>

namespace pointgi {

/// A variant of octree and traversal, nothing left open. What goes with what: host/tune/variant_list.h.
struct TraversalVariant {
  TraversalForm form = TraversalForm::step;
  unsigned axis_bits = 1; ///< log2 N of the tree
  PointOrder order = PointOrder::morton;
  unsigned leaf_capacity = 32;
  unsigned max_depth = 21;
  unsigned lanes = 8;                        ///< wide form only
  PoolStorage storage = PoolStorage::buffer; ///< step form only, as is stepping
  Stepping stepping = Stepping::exact;
  double step_delta = 0.05; ///< world units; absolute_delta only
  RayGrouping grouping = RayGrouping::ray;
  WorkGroup group;
  bool fast_math = false;
  bool clips = false;   ///< of the scene, not of the choice: some splats end at borders
  bool patches = false; ///< as well: splats are patches of the moving-least-squares surface, and no discs
};

/// Tells variants apart, for people and for --filter: "step-n2-buffer-morton-leaf32-ray-8x4",
/// "wide-lanes8-morton-leaf64-packet-8x4-fast".
std::string name_of(const TraversalVariant& variant);

/// What the scene has, so that kernels are built without what it has not (method.md §7).
struct SceneFeatures {
  unsigned lights = 0; ///< bit LIGHT_<ID> of each kind of [[light]] (shared/light_kinds.h)
  bool emitters = false;
  bool environment = false;
  bool radiosity = false;      ///< of the picture: points have irradiance from surfaces
  bool shadow_rays = true;     ///< of the picture: direct light comes by them, not with the points' irradiance
  unsigned materials = 0;      ///< bit MATERIAL_<ID> of each kind of material (shared/material_kinds.h)
  unsigned material_flags = 0; ///< what these materials do: MATERIAL_...; kinds count only where one is specular
  unsigned gather_k = 0;       ///< of the picture: photons an estimate of caustics; 0: there are none
  bool sky_map = false;        ///< light from all around is a map
  unsigned cone_texels = 0;    ///< of the picture: of a voxel, where pixels gather light between surfaces by cones
  bool stored_direct = false;  ///< of the picture: points hold what is known of their direct light
  bool auxiliary = false;      ///< of the picture: its film has what guides a denoiser

  bool specular() const { return (material_flags & MATERIAL_SPECULAR) != 0; }
};

/// Every kind of material, or of light.
constexpr unsigned all_materials = (1u << MATERIAL_KIND_COUNT) - 1u, all_lights = (1u << LIGHT_KIND_COUNT) - 1u;
/// What some of them do.
constexpr unsigned all_material_flags =
    MATERIAL_REFLECTS_DIFFUSELY | MATERIAL_SPECULAR | MATERIAL_HAS_LOBE | MATERIAL_TRANSMITS;
/// The features that programs of this device are built with. CPU devices: those of the scene, and no more. Others: one
/// of few sets that hold them (all lights, all specular materials), so that every program which a scene may ask for can
/// be listed (host/tune/variant_list.h), checked and compiled before; what a scene lacks costs such a program a test.
SceneFeatures features_on(const DeviceInfo& device, const SceneFeatures& of_scene);

/// Rows of the image2d form hold 2^image_width_log2 texels: 4096, which every OpenCL 1.2 device with images allows.
constexpr unsigned image_width_log2 = 12;

/// A file below kernels/ and what it is built with.
struct Program {
  std::string file;
  std::string options;
};

/// Given rays: trace_closest_rays, trace_any_rays, trace_blended_rays; with grouping packet also
/// trace_packets. Where backs are seen through, nearest hits are those of front sides.
Program trace_program(const TraversalVariant& variant, Backfaces backfaces = Backfaces::shade);
/// The same rays by a linear scan over the variant's splats, brute_force_closest: what all others are held to.
Program scan_program(const TraversalVariant& variant, Backfaces backfaces = Backfaces::shade);
/// Hits of the picture's eye rays, trace_eye_rays: a pixel a half or whole work-group, or (packets) a square of pixels
/// a work-item.
Program eye_rays_program(const TraversalVariant& variant, Backfaces backfaces = Backfaces::shade);
/// The picture from these hits, shade_pixels: a pixel a half or whole work-group.
Program shade_program(const TraversalVariant& variant, const SceneFeatures& features);
/// Direct irradiance of the points, direct_irradiance_of_points.
Program direct_irradiance_program(const TraversalVariant& variant, const SceneFeatures& features);

/// Given rays through specular surfaces, trace_specular_rays, for tests.
Program specular_rays_program(const TraversalVariant& variant);
/// Everything that is drawn at random, for tests.
Program samplers_program(const TraversalVariant& variant);

/// Visibility between points for the V-map, segments_blocked.
Program segments_program(const TraversalVariant& variant);
/// Visibility of all pairs of points for the direct solver, pairs_visible; of points and senders, senders_visible,
/// which are picked anew in each pass with `monte_carlo`. `voxels`: a side of the occupancy grid that is marched
/// through, a power of two from 32 to 128; 0: by rays.
Program pairs_program(const TraversalVariant& variant, unsigned voxels = 0);
Program senders_program(const TraversalVariant& variant, unsigned voxels, bool monte_carlo);

/// Whether directions_program() has BEAM_RAYS points a work-item: with grouping packet, but for patches, which beams do
/// not know, and a hemicube, whose directions neighbours do not share.
bool directions_in_beams(const TraversalVariant& variant, bool hemicube);
/// What points see in directions of their own, trace_directions.
Program directions_program(const TraversalVariant& variant, bool hemicube);
/// For what points see of the sky in those directions.
Program sky_program(bool hemicube, bool map);

/// The picture by path tracing, path_pixels: a pixel a work-group of 8x4; never with fast math, for it is what others
/// are measured by. `some_paths`: params.path_states leaves some out.
Program path_program(const TraversalVariant& variant, const SceneFeatures& features, bool some_paths);

/// Radiosity: a file of kernels/radiosity whose work-items take `lanes` of a block of FMM_LANES nodes or points, all or
/// 1; nothing in it depends on the traversal.
Program fmm_program(const char* file, unsigned lanes);
/// What suits the device: all where a work-item has vector registers of its own, as on CPU devices, else 1.
unsigned fmm_lanes_on(const DeviceInfo& device);
/// Work-items that a block has there, FMM_LANES over the lanes of each.
std::size_t fmm_items_on(const DeviceInfo& device);
/// Voxel cone tracing: a file of kernels/radiosity/cones. `texels`: of a voxel; 0 for voxelise.cl, which does not ask.
Program cones_program(const char* file, unsigned texels = 0);

/// Where photons set out.
enum class PhotonStart {
  aimed,        ///< at sources, aimed at leaves, with the power that makes their sum unbiased
  equal_power,  ///< the same with equal powers, as in the thesis
  from_surfaces ///< where specular splats see what sends them diffuse light (kernels/photon/emit_from_surfaces.cl)
};

/// Photons by way of specular surfaces to diffuse ones, trace_photons.
Program trace_photons_program(const TraversalVariant& variant, const SceneFeatures& features, PhotonStart start);
/// Irradiance of given places by the k nearest photons, caustic_irradiance.
Program caustic_irradiance_program(unsigned k);
/// What the k nearest photons bring to the points of the pool, caustics_of_points.
Program caustics_of_points_program(unsigned k);
/// Nearest photons of given places, nearest_of_places, for k up to this many.
Program nearest_photons_program(unsigned k);
/// Room for photons that a program is built with, to gather k of them: few sizes, or each k would be compiled anew.
unsigned gather_room(unsigned k);

/// What every program of the variant has in common: the pools and the walk through them.
std::string build_options(const TraversalVariant& variant);

} // namespace pointgi
