#include "host/cloud/readers/mesh.h"
#include "host/cloud/input_file.h"
#include "host/cloud/precision.h"
#include "host/cloud/readers/mesh_checks.h"
#include "host/cloud/readers/mesh_sample.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cmath>

namespace pointgi {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr double default_points = 200e3;
constexpr double most_points = 100e6;

Vector3d to_vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
Vector3f to_colour(const aiColor4D& c) {
  return Vector3f(c.r, c.g, c.b).cwiseMax(0.0f).cwiseMin(1.0f);
}

/// A material's colour, and whether the file had it or assimp made it up.
struct MaterialColour {
  Vector3f colour = Vector3f::Ones();
  bool from_file = false;
  bool textured = false;
};

MaterialColour colour_of(const aiMaterial& material) {
  MaterialColour result;
  aiColor4D diffuse(1.0f, 1.0f, 1.0f, 1.0f);
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) == aiReturn_SUCCESS) result.colour = to_colour(diffuse);
  aiString name;
  material.Get(AI_MATKEY_NAME, name);
  // A file without materials gets one of this name, or a nameless grey of 0.6: no wish of the user's.
  const bool grey = (result.colour - Vector3f::Constant(0.6f)).cwiseAbs().maxCoeff() < 1e-6f;
  result.from_file = std::string(name.C_Str()) != AI_DEFAULT_MATERIAL_NAME && !(name.length == 0 && grey);
  result.textured =
      material.GetTextureCount(aiTextureType_DIFFUSE) > 0 || material.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
  return result;
}

/// All triangles of a scene, in world space.
struct Soup {
  std::vector<MeshTriangle> triangles;
  bool has_colour = false;
  bool has_texture = false;
  bool has_normals = true; ///< all of its meshes
};

void add_mesh(const aiMesh& mesh, const aiScene& scene, const Eigen::Affine3d& place, Soup& soup) {
  const MaterialColour material =
      mesh.mMaterialIndex < scene.mNumMaterials ? colour_of(*scene.mMaterials[mesh.mMaterialIndex]) : MaterialColour{};
  soup.has_colour = soup.has_colour || mesh.HasVertexColors(0) || material.from_file;
  soup.has_texture = soup.has_texture || material.textured;
  soup.has_normals = soup.has_normals && mesh.HasNormals();
  // Cofactors carry normals along; unlike the inverse they exist for any matrix. A mirror turns the winding inside out
  // and, through the sign of the cofactors, the normals as well: both are turned back.
  const Eigen::Matrix3d m = place.linear();
  const double sign = m.determinant() < 0.0 ? -1.0 : 1.0;
  Eigen::Matrix3d cofactors;
  cofactors.col(0) = sign * m.col(1).cross(m.col(2));
  cofactors.col(1) = sign * m.col(2).cross(m.col(0));
  cofactors.col(2) = sign * m.col(0).cross(m.col(1));

  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    const auto valid = [&mesh](unsigned index) { return index < mesh.mNumVertices; };
    // Points and lines have fewer corners; polygons were cut up while loading.
    if (face.mNumIndices != 3 || !std::all_of(face.mIndices, face.mIndices + 3, valid)) continue;
    MeshTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned index = face.mIndices[k];
      const std::size_t corner = sign < 0.0 && k > 0 ? 3 - k : k;
      t.position[corner] = place * to_vector(mesh.mVertices[index]);
      t.normal[corner] = mesh.HasNormals()
                             ? Vector3f((cofactors * to_vector(mesh.mNormals[index])).normalized().cast<float>())
                             : Vector3f::Zero();
      t.colour[corner] = mesh.HasVertexColors(0) ? to_colour(mesh.mColors[0][index]) : material.colour;
    }
    soup.triangles.push_back(t);
  }
}

Eigen::Affine3d to_affine(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column)
      matrix(row, column) = static_cast<double>(m[row][column]);
  return Eigen::Affine3d(matrix);
}

Soup triangles_of(const aiScene& scene) {
  struct Visit {
    const aiNode* node;
    Eigen::Affine3d parent;
  };
  Soup soup;
  std::vector<Visit> open{{scene.mRootNode, Eigen::Affine3d::Identity()}};
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const Eigen::Affine3d place = visit.parent * to_affine(visit.node->mTransformation);
    for (unsigned i = 0; i < visit.node->mNumMeshes; ++i)
      add_mesh(*scene.mMeshes[visit.node->mMeshes[i]], scene, place, soup);
    for (unsigned i = 0; i < visit.node->mNumChildren; ++i)
      open.push_back({visit.node->mChildren[i], place});
  }
  return soup;
}

Soup load(const std::string& path, CloudReport& report) {
  require_regular_file(path);
  check_mesh_file(path);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene != nullptr) {
    for (unsigned m = 0; m < scene->mNumMeshes; ++m)
      prepare_to_cut(*scene->mMeshes[m], path);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  }
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw Error(ErrorKind::input, path + ": cannot be read as a mesh: " + printable(importer.GetErrorString(), 200) +
                                      "; expected a PLY cloud or a mesh such as OBJ, STL, OFF or glTF");
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* about = index >= 0 ? importer.GetImporterInfo(static_cast<std::size_t>(index)) : nullptr;
  report.format = about != nullptr ? "mesh (" + std::string(about->mName) + ")" : "mesh";
  return triangles_of(*scene);
}

void describe(const Soup& soup, CloudReport& report) {
  report.properties.push_back({"mesh.vertices (float)", "position"});
  report.properties.push_back({"mesh.normals", soup.has_normals ? "normal" : "normal (from the faces where absent)"});
  if (soup.has_colour) report.properties.push_back({"mesh.colours", "colour"});
  if (soup.has_texture) report.properties.push_back({"mesh.textures", "not used"});
  if (soup.has_texture)
    report.warnings.push_back("the mesh has textures, which are not read: it gets its materials' plain colours. Bake "
                              "the textures into vertex colours if they matter.");
  report.triangles = soup.triangles.size();
  const auto flat = std::count_if(soup.triangles.begin(), soup.triangles.end(),
                                  [](const MeshTriangle& t) { return !(usable_area(t) > 0.0); });
  if (flat > 0)
    report.warnings.push_back(std::to_string(flat) +
                              " triangles have no area or corners that are not finite and got no points.");
  std::vector<Vector3d> corners;
  corners.reserve(3 * soup.triangles.size());
  for (const MeshTriangle& t : soup.triangles)
    corners.insert(corners.end(), t.position.begin(), t.position.end());
  if (const auto warning = float_precision_warning(corners, {true, true, true})) report.warnings.push_back(*warning);
}

} // namespace

PointCloud sample_mesh(const std::string& path, double spacing, CloudReport& report) {
  if (!(spacing >= 0.0) || !std::isfinite(spacing))
    throw Error(ErrorKind::input, path + ": the spacing is " + std::to_string(spacing) +
                                      ", expected a positive length, or 0 to have it chosen");
  const Soup soup = load(path, report);
  if (soup.triangles.empty())
    throw Error(ErrorKind::input, path + ": the mesh has no triangles; save it with its faces, or a bare cloud as PLY");
  const double area = total_area(soup.triangles);
  if (!(area > 0.0) || !std::isfinite(area))
    throw Error(ErrorKind::input, path + ": all " + std::to_string(soup.triangles.size()) +
                                      " triangles are degenerate (no area); expected a surface");
  const double wanted = spacing > 0.0 ? std::max(1.0, area / (spacing * spacing)) : default_points;
  if (!(wanted <= most_points))
    throw Error(ErrorKind::input, path + ": a spacing of " + std::to_string(spacing) +
                                      " would make more than 100 million points on an area of " + std::to_string(area) +
                                      "; choose " + std::to_string(std::sqrt(area / most_points)) + " or more");
  describe(soup, report);
  PointCloud cloud = sample_triangles(soup.triangles, wanted, soup.has_colour);
  report.points_in_file = cloud.size();
  return cloud;
}

bool has_mesh_extension(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return !extension.empty() && Assimp::Importer().IsExtensionSupported(extension);
}

std::vector<std::string> files_beside_mesh(const std::string& path) {
  const char* extension = has_extension(path, ".obj") ? ".mtl" : has_extension(path, ".gltf") ? ".bin" : nullptr;
  std::vector<std::string> files;
  if (extension == nullptr) return files;
  std::error_code failed; // then the mesh cannot be read either, which is said elsewhere
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::absolute(path).parent_path(), failed))
    if (has_extension(entry.path().string(), extension)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace pointgi
