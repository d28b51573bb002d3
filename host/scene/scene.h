#pragma once
/// The scene as the file describes it, in world units and doubles: nothing loaded, nothing sampled yet.
#include "host/cloud/complete.h"
#include "host/cloud/select.h"
#include "octree/build/curve.h"
#include "shared/render_types.h"
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pointgi {

using Eigen::Vector3d;

/// Where an entry of the scene stands: "scene.toml:12:3". Errors found after parsing still name it.
struct SourcePlace {
  std::string file;
  unsigned line = 0;
  unsigned column = 0;
  std::string text() const; ///< "file:line:column", or "--set" / "(default)" where there is no line
};

/// What eye rays make of the backs of surfaces; all other rays meet both sides.
enum class Backfaces {
  shade,       ///< they are black
  see_through, ///< they are not there
};
const char* name_of(Backfaces backfaces);

/// An axis, or the opposite of one.
enum class UpAxis { y, z, x, minus_y, minus_z, minus_x };
const char* name_of(UpAxis up); ///< "y", "-z"
const std::vector<UpAxis>& up_axes();
Vector3d direction_of(UpAxis up); ///< unit
enum class ColourSpace { srgb, linear };

struct RenderSettings {
  int width = 640;
  int height = 480;
  int spp = 32; ///< samples a pixel
  unsigned seed = 1;
  double exposure = 0.0;        ///< stops, for the PNG only
  bool auto_exposure = false;   ///< instead chosen from the picture (host/image/exposure.h)
  std::optional<int> max_depth; ///< most surface points of a path from light to eye; absent: no limit
  bool jitter = true;
  bool adaptive = true; ///< few samples of a pixel in which nothing changes are shaded
};

struct CameraSettings {
  Vector3d position{0, 0, 0};
  Vector3d look_at{0, 0, -1};
  double fov_deg = 40.0;              ///< vertical
  std::optional<Vector3d> up;         ///< instead of the scene's axis
  bool chosen = false;                ///< the file has a [camera]; without one the program finds a view
  std::optional<Backfaces> backfaces; ///< absent: shade, or what a chosen view asks for
  SourcePlace place;
};

#define MATERIAL_TYPE(ID, name) name = MATERIAL_##ID,
enum class MaterialType : pg_uint { MATERIAL_KINDS(MATERIAL_TYPE) };
#undef MATERIAL_TYPE
const char* name_of(MaterialType type);

/// Reflectance by numbers that the file has for its points.
struct FieldAlbedo {
  std::vector<std::string> fields; ///< one: grey; three: red, green and blue
  std::optional<double> low, high; ///< of black and white; absent: where 1 % and 99 % of the values lie below
};

struct MaterialSettings {
  std::string name;
  MaterialType type = MaterialType::diffuse;
  std::optional<Vector3d> albedo;               ///< always linear; absent: the points' colours
  std::optional<FieldAlbedo> albedo_field;      ///< instead of the points' colours, encoded as they are
  Vector3d emission{0, 0, 0};                   ///< radiance [W/m²/sr] of the front side
  pg_uint flags = 0;                            ///< MATERIAL_... of shared/material_kinds.h
  bool one_sided = false;                       ///< two_sided = false: even points that have no side have only a front
  Vector3d specular{0, 0, 0};                   ///< reflectance of the specular part (Material::specular)
  double exponent = 1.0;                        ///< of a Phong lobe
  double ior = 1.5;                             ///< of glass
  Vector3d absorption{0, 0, 0};                 ///< of glass, 1/length
  Vector3d eta{0, 0, 0}, extinction{0, 0, 0};   ///< of a conductor: complex index of refraction; 0: `specular` instead
  double alpha = 0.0;                           ///< of a conductor: width of the GGX distribution of normals
  ColourSpace colour_space = ColourSpace::srgb; ///< of the points' colours
  SourcePlace place;
};

/// Whether its splats send and receive diffuse light. Specular ones do not; they block it (method.md §1).
bool exchanges_light(const MaterialSettings& material);

struct CloudSettings {
  std::string file;     ///< absolute, or relative to the working directory: already joined with the scene's folder
  std::string material; ///< name of a material; checked to exist
  double scale = 1.0;
  Vector3d rotate_deg{0, 0, 0}; ///< about x, then y, then z
  Vector3d translate{0, 0, 0};
  NormalSource normals = NormalSource::automatic;
  RadiusSource radii = RadiusSource::automatic;
  StrayPolicy strays = StrayPolicy::drop;
  std::optional<double> radius;      ///< one radius for all points, world units after scaling
  std::optional<Vector3d> viewpoint; ///< sensor position in the file's coordinates
  Selection selection;               ///< which of the file's points are wanted
  double spacing = 0.0;              ///< for meshes: distance of the sampled splats, world units; 0 = chosen
  SourcePlace place;
  std::shared_ptr<const PointCloud> points; ///< in memory, called `file`; null: in that file
};

struct QuadShape {
  Vector3d corner, edge_u, edge_v;
};
struct SphereShape {
  Vector3d centre;
  double radius;
  bool inward = false;
};
struct BoxShape {
  Vector3d min, max;
  bool inward = false;
};
struct DiscShape {
  Vector3d centre, normal;
  double radius;
};
struct CylinderShape { ///< open tube from `base` to `top`
  Vector3d base, top;
  double radius;
  bool inward = false;
};
using ShapeGeometry = std::variant<QuadShape, SphereShape, BoxShape, DiscShape, CylinderShape>;

struct ShapeSettings {
  ShapeGeometry geometry;
  double spacing = 0.0; ///< world units between neighbouring splats
  std::string material;
  SourcePlace place;
};

#define LIGHT_TYPE(ID, name) name = LIGHT_##ID,
enum class LightType : pg_uint { LIGHT_KINDS(LIGHT_TYPE) };
#undef LIGHT_TYPE
const char* name_of(LightType type);

struct EnvironmentMap; // host/lights/environment_map.h

struct LightSettings {
  LightType type = LightType::point;
  bool is_far = false;        ///< parallel light from outside the scene
  Vector3d vector{0, 0, 0};   ///< its position; of a far light the unit vector towards it
  Vector3d strength{0, 0, 0}; ///< intensity [W/sr]; of a far light the irradiance [W/m²] of a surface that faces it
  double sine2 = 0.0;         ///< of a far light: sine squared of half the angle under which it is seen
  SourcePlace place;
  std::shared_ptr<const EnvironmentMap> sky = nullptr; ///< that the light brings, or null
};

struct RadiositySettings {
  std::string method = "auto"; ///< chosen from the scene (host/radiosity/plan.h); "none": direct light only
  double least_share = 1e-3;   ///< of the direct light that is reflected: less light between surfaces is not solved for
  int order = 3;
  int vmap_samples = 8;               ///< segments a pair of clusters
  int point_samples = 128;            ///< LinkOptions::point_samples (octree/vmap/make_links.h)
  std::optional<long long> vmap_rays; ///< LinkOptions::most_rays; absent: default_vmap_rays (host/radiosity)
  double epsilon = 5e-3; ///< share of light below which a pair of clusters is not divided (octree/vmap/make_links.h)
  double tolerance = 1e-3;
  int directions = 64;                      ///< of method "directions": of each point
  bool share = true;                        ///< as well: neighbours share what theirs have found
  std::string direction_set = "stratified"; ///< or "hemicube" (host/radiosity/direction_set.h)
  std::string sampling =
      "all";        ///< of method "gather": "static", "monte_carlo", "mipmap", "adaptive" (host/radiosity/gather.h)
  int window = 128; ///< points that one sender stands for, at most, where not all send
  std::optional<bool> reciprocity;      ///< one ray a pair for both directions; absent: where all send
  std::optional<bool> visibility_cache; ///< kept for later passes; absent: where these ask for the same pairs
  std::string visibility = "rays";      ///< or "voxels": by marching through an occupancy grid
  int voxels = 64;                      ///< a side of that grid, and of the finest of method "cones"
  int passes = 0;                       ///< bounces, at most; 0: until the tolerance is reached
  std::string vmap = "fractions"; ///< "thesis": one segment a pair of clusters, between their centroids (method.md §3)
  int cones = 9;                  ///< of a point
  bool anisotropic = true;        ///< a voxel keeps its light an axis direction
  std::string at = "points";      ///< "pixels": cones of the picture's pixels, too, instead of light between points
  std::string direct_light = "auto"; ///< shadow rays at pixels where points do not know it; "shadow_rays": everywhere;
                                     ///< "radiosity": the thesis' way, none (method.md §6)
  std::optional<int> light_samples;  ///< estimates of the direct light of a point; absent: as many as its use needs
  std::vector<std::string> notes;    ///< what the log should say of the keys: those that the method does not read
  std::optional<SourcePlace> place;  ///< set when the file has the section
};
struct CausticSettings {
  long long photons = 400000;
  int gather_k = 50;
  std::string power = "unbiased";
  std::optional<double>
      max_radius;        ///< world units: photons farther off do not count; absent: a part of the scene's size
  bool feedback = false; ///< LS+D+: diffuse surfaces pass on what photons bring them
  bool indirect = false; ///< LD+S+D: photons of the light that specular surfaces get from diffuse ones, too
  std::optional<SourcePlace> place;
};

/// Form of the octree; the picture does not depend on it beyond rounding. What is left open is chosen for the device
/// (host/tune/tuned.h).
struct OctreeSettings {
  std::optional<unsigned> branching; ///< N of the N^d tree: 2 or 4
  std::optional<PointOrder> order;
  std::optional<unsigned> leaf_capacity; ///< splats that a cell may list undivided
  unsigned max_depth = 21;               ///< levels below the root; N = 4 has 10 at most
};

enum class TraversalForm {
  step, ///< cells, Begin-End pool, extra splats (method.md §2, §6)
  wide  ///< tight child boxes, blocks of splats; for devices with vectors a work-item
};
enum class PoolStorage { buffer, image1d_buffer, image2d };
enum class Stepping {
  exact,         ///< integer cells; the default
  absolute_delta ///< the thesis' absolute delta, for trade measurements (method.md §6)
};
enum class RayGrouping {
  ray,   ///< a ray a work-item
  packet ///< the eye rays of 2 x 2 pixels a work-item, direction k of BEAM_RAYS points
};
struct WorkGroup { ///< shape of a work-group; kernels over one dimension take the product
  unsigned x = 8, y = 4;
  unsigned size() const { return x * y; }
};
inline bool operator==(WorkGroup a, WorkGroup b) {
  return a.x == b.x && a.y == b.y;
}

enum class SurfaceForm {
  discs, ///< flat
  mls    ///< patches of the moving-least-squares surface (host/cloud/mls_patches.h)
};

/// Kernel variant of the traversal. What is left open is chosen for the device; what goes with what is told by
/// host/tune/variant_list.h.
struct TraversalSettings {
  std::optional<TraversalForm> form;
  std::optional<RayGrouping> grouping;
  std::optional<WorkGroup> group;     ///< one of work_groups()
  std::optional<unsigned> lanes;      ///< splats a block of the wide form, 8 or 16
  std::optional<PoolStorage> storage; ///< of the step form
  Stepping stepping = Stepping::exact;
  double step_delta = 0.05;                 ///< world units; absolute_delta only
  bool fast_math = false;                   ///< looser float rules; the picture is then approximate
  SurfaceForm surface = SurfaceForm::discs; ///< what splats are; no choice of the device's
  unsigned mls_neighbours = 24;             ///< to which a patch is fitted (docs/method/mls.md)
};

/// The words that a scene file has for these, each beside its meaning; every value of a type, in order.
const char* name_of(PointOrder order);
const char* name_of(TraversalForm form);
const char* name_of(PoolStorage storage);
const char* name_of(Stepping stepping);
const char* name_of(RayGrouping grouping);
const char* name_of(SurfaceForm surface);
std::string name_of(WorkGroup group); ///< "8x4"
const std::vector<PointOrder>& point_orders();
const std::vector<TraversalForm>& traversal_forms();
const std::vector<PoolStorage>& pool_storages();
const std::vector<RayGrouping>& ray_groupings();
const std::vector<WorkGroup>& work_groups();

struct Scene {
  std::string file;
  UpAxis up = UpAxis::y;
  bool up_chosen = false; ///< the file says which way is up; else a chosen camera finds out
  bool ground = false;    ///< a ground plane goes under what stands free (host/view/ground.h)
  RenderSettings render;
  CameraSettings camera;
  std::vector<MaterialSettings> materials;
  std::vector<CloudSettings> clouds;
  std::vector<ShapeSettings> shapes;
  std::vector<LightSettings> lights;
  Vector3d environment{0, 0, 0};             ///< radiance [W/m²/sr] from every direction; 0 where there is a map
  std::shared_ptr<const EnvironmentMap> sky; ///< light from all around that is not the same everywhere, or null
  std::string environment_file;              ///< absolute: where the environment's map was read; empty: there is none
  RadiositySettings radiosity;
  CausticSettings caustics;
  OctreeSettings octree;
  TraversalSettings traversal;
  std::vector<std::string> warnings;
};

} // namespace pointgi
