#include "host/stages/lit_file.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/las_write.h"
#include "host/cloud/readers/ply_columns.h"
#include "host/image/srgb.h"
#include "host/stages/file_answers.h"
#include <algorithm>
#include <set>

namespace pointgi {

namespace {

const std::vector<std::string> own_colours = {"red", "green", "blue"};
constexpr const char* axes[] = {"x", "y", "z"};

std::string albedo_name(const std::string& colour) {
  return "albedo_" + colour;
}

/// What is known of the points of a file, as columns by their numbers there. `lit` and `ready` outlive them.
class ResultColumns {
public:
  ResultColumns(const Scene& scene, const PreparedScene& ready, const LitCloud& lit)
      : scene_(scene), ready_(ready), lit_(lit), answers_(ready) {}

  std::vector<PointColumn> results() const {
    std::vector<PointColumn> columns{
        {"lit", FieldType::u8, [this](std::size_t record) { return is_lit(record) ? 1.0 : 0.0; }}};
    for (int c = 0; c < 3 && !lit_.cloud.colour.empty(); ++c)
      columns.push_back({own_colours[static_cast<std::size_t>(c)], FieldType::u8,
                         [this, c](std::size_t record) { return byte(record, c); }});
    for (const bool back : {false, true})
      for (const PlyColumn& column : lit_.columns)
        if (!back || answers_.has_backs())
          columns.push_back({column.name + (back ? "_back" : ""), FieldType::f32,
                             [this, &column, back](std::size_t record) { return value(column, record, back); }});
    return columns;
  }

  /// Normals and radii of the splats, in the file's coordinates.
  std::vector<PointColumn> normals() const {
    std::vector<PointColumn> columns;
    const Eigen::Matrix3d to_file = rotation_of(scene_.clouds[0]).transpose();
    for (int k = 0; k < 3; ++k)
      columns.push_back({std::string("n") + axes[k], FieldType::f32, [this, k, to_file](std::size_t record) {
                           const std::uint32_t point = answers_.front(record);
                           if (point == FileAnswers::none) return 0.0;
                           return to_file.row(k).dot(lit_.cloud.normal[point].cast<double>());
                         }});
    return columns;
  }
  PointColumn radius() const {
    return {"radius", FieldType::f32, [this](std::size_t record) {
              const std::uint32_t point = answers_.front(record);
              if (point == FileAnswers::none) return 0.0;
              return static_cast<double>(lit_.cloud.radius[point]) / scene_.clouds[0].scale;
            }};
  }

private:
  bool is_lit(std::size_t record) const {
    const std::uint32_t point = answers_.front(record);
    return point != FileAnswers::none && exchanges_light(scene_.materials[material_of(ready_.points[point])]);
  }

  double value(const PlyColumn& column, std::size_t record, bool back) const {
    const std::uint32_t point = back ? answers_.back(record) : answers_.front(record);
    return is_lit(record) && point != FileAnswers::none ? static_cast<double>(column.values[point]) : 0.0;
  }

  double byte(std::size_t record, int channel) const {
    if (!is_lit(record)) return 0.0;
    const std::uint32_t back = answers_.back(record);
    float shown = lit_.cloud.colour[answers_.front(record)][channel];
    if (back != FileAnswers::none)
      shown = linear_to_srgb(0.5f * (srgb_to_linear(shown) + srgb_to_linear(lit_.cloud.colour[back][channel])));
    return 255.0 * static_cast<double>(shown);
  }

  const Scene& scene_;
  const PreparedScene& ready_;
  const LitCloud& lit_;
  FileAnswers answers_;
};

bool has_any(const std::vector<std::string>& names, std::initializer_list<const char*> wanted) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return std::find(wanted.begin(), wanted.end(), lookup_name(name)) != wanted.end();
  });
}

/// The results, and what a file with fields of these names lacks.
std::vector<PointColumn> columns_beside(const ResultColumns& results, const std::vector<std::string>& names) {
  std::vector<PointColumn> columns;
  if (!has_any(names, {"nx", "normal_x", "normalx"})) columns = results.normals();
  if (!has_any(names, {"radius"})) columns.push_back(results.radius());
  for (PointColumn& column : results.results())
    columns.push_back(std::move(column));
  return columns;
}

bool is_ply(const std::string& path) {
  const InputFile file(path);
  char magic[4] = {};
  if (file.size() < sizeof magic) return false;
  file.read(0, magic, sizeof magic);
  return std::string(magic, 3) == "ply" && (magic[3] == '\n' || magic[3] == '\r');
}

void write_ply_again(const std::string& output, const std::string& source, const ResultColumns& results) {
  std::map<std::string, std::string> kept_as;
  for (const std::string& colour : own_colours)
    kept_as[colour] = albedo_name(colour);
  write_ply_with_columns(source, output, columns_beside(results, ply_vertex_properties(source)), kept_as);
}

/// A cloud in memory as fields.
std::vector<PointColumn> attributes_of(const PointCloud& cloud) {
  std::vector<PointColumn> columns;
  for (int k = 0; k < 3; ++k)
    columns.push_back({axes[k], FieldType::f64, [&cloud, k](std::size_t i) { return cloud.position[i][k]; }});
  for (int k = 0; k < 3 && !cloud.normal.empty(); ++k)
    columns.push_back({std::string("n") + axes[k], FieldType::f32,
                       [&cloud, k](std::size_t i) { return static_cast<double>(cloud.normal[i][k]); }});
  for (int c = 0; c < 3 && !cloud.colour.empty(); ++c)
    columns.push_back({own_colours[static_cast<std::size_t>(c)], FieldType::f32,
                       [&cloud, c](std::size_t i) { return static_cast<double>(cloud.colour[i][c]); }});
  if (!cloud.radius.empty())
    columns.push_back(
        {"radius", FieldType::f32, [&cloud](std::size_t i) { return static_cast<double>(cloud.radius[i]); }});
  return columns;
}

/// The fields of a file that is no PLY, as properties.
std::vector<PointColumn> fields_as_columns(const PointCloud& cloud) {
  std::vector<PointColumn> columns;
  for (const Field& field : cloud.fields) {
    const bool scaled = field.info.scale != 1.0 || field.info.offset != 0.0; // what is stored is no whole number
    std::string name = field.info.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c <= ' ' || c > '~'; }, '_');
    columns.push_back(
        {name, scaled ? FieldType::f64 : field.info.type, [&field](std::size_t i) { return field.values[i]; }});
  }
  return columns;
}

/// Behind `own`, which are asked for by row, the results, which are asked for by record.
void write_with_results(const std::string& output, const PointCloud& cloud, std::vector<PointColumn> own,
                        const ResultColumns& results) {
  std::vector<std::string> names;
  for (const PointColumn& column : own)
    names.push_back(column.name);
  std::vector<PointColumn> behind = columns_beside(results, names);
  std::set<std::string> taken;
  for (const PointColumn& column : behind)
    taken.insert(column.name);
  std::vector<PointColumn> columns;
  for (PointColumn& column : own) {
    const std::string looked_up = lookup_name(column.name);
    const bool is_colour = has_any({looked_up}, {"red", "green", "blue"});
    if (is_colour && taken.count(looked_up) > 0) column.name = albedo_name(looked_up);
    if (taken.insert(column.name).second) columns.push_back(std::move(column)); // a result counts before a field
  }
  for (PointColumn& column : behind) {
    if (!cloud.record.empty())
      column.value = [&cloud, by_record = std::move(column.value)](std::size_t row) {
        return by_record(cloud.record[row]);
      };
    columns.push_back(std::move(column));
  }
  write_ply_columns(output, cloud.size(), columns);
}

} // namespace

void write_lit_ply(const std::string& output, const Scene& scene, const PreparedScene& ready, const LitCloud& lit) {
  if (!ready.file_order) return write_ply(output, lit.cloud, lit.columns);
  const ResultColumns results(scene, ready, lit);
  const CloudSettings& settings = scene.clouds[0];
  if (settings.points) return write_with_results(output, *settings.points, attributes_of(*settings.points), results);
  if (is_ply(settings.file)) return write_ply_again(output, settings.file, results);
  CloudReport ignored;
  const PointCloud cloud = read_cloud(settings.file, {0.0, {}, true}, ignored);
  // A format without names of fields gives attributes alone.
  write_with_results(output, cloud, cloud.fields.empty() ? attributes_of(cloud) : fields_as_columns(cloud), results);
}

bool can_write_las(const Scene& scene) {
  return scene.clouds.size() == 1 && scene.shapes.empty() && !scene.clouds[0].points &&
         (has_extension(scene.clouds[0].file, ".las") || has_extension(scene.clouds[0].file, ".laz"));
}

void write_lit_las(const std::string& output, const Scene& scene, const PreparedScene& ready, const LitCloud& lit) {
  const ResultColumns results(scene, ready, lit);
  const std::string& source = scene.clouds[0].file;
  const bool coloured = !lit.cloud.colour.empty() && las_holds_colour(source);
  CloudReport report;
  const PointCloud cloud =
      read_cloud(source, {0.0, coloured ? own_colours : std::vector<std::string>(), false}, report);
  const std::size_t records = report.points_in_file;
  std::vector<Field> columns;
  std::vector<Eigen::Vector3f> colour(coloured ? records : 0);
  for (const PointColumn& column : results.results()) {
    const auto channel = std::find(own_colours.begin(), own_colours.end(), column.name) - own_colours.begin();
    if (channel < 3) {
      for (std::size_t i = 0; i < colour.size(); ++i)
        colour[i][channel] = static_cast<float>(column.value(i) / 255.0);
      continue;
    }
    Field& field = columns.emplace_back();
    field.info = {lookup_name(column.name), column.type, 1.0, 0.0};
    field.values.resize(records);
    for (std::size_t i = 0; i < records; ++i)
      field.values[i] = column.value(i);
  }
  for (const Field& own : cloud.fields) {
    const std::string name = albedo_name(lookup_name(own.info.name));
    if (has_any(report.fields, {name.c_str()})) continue; // of an earlier run: the first ones are the scan's
    Field& field = columns.emplace_back();
    field.info = {name, own.info.type, 1.0, 0.0};
    field.values.resize(records);
    for (std::size_t i = 0; i < cloud.size(); ++i)
      field.values[cloud.record.empty() ? i : cloud.record[i]] = own.values[i];
  }
  write_las_with_columns(source, output, columns, colour);
}

} // namespace pointgi
