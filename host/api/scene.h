#pragma once
/// What is rendered: from a file, from a text, or built in code with the keys of scene files (docs/reference.md).
/// Lengths are in the scene's own unit, colours are linear RGB, coordinates right-handed.
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace pointgi::api {

/// The value of a key: true, 12, 0.5, "diffuse", {0.7, 0.7, 0.7}.
class Value {
public:
  Value(bool value) : value_(value) {}
  template <typename Integer, std::enable_if_t<std::is_integral_v<Integer> && !std::is_same_v<Integer, bool>, int> = 0>
  Value(Integer value) : value_(static_cast<long long>(value)) {}
  Value(double value) : value_(value) {}
  Value(const char* text) : value_(std::string(text)) {}
  Value(std::string text) : value_(std::move(text)) {}
  Value(std::initializer_list<double> values) : value_(std::vector<double>(values)) {}
  Value(std::vector<double> values) : value_(std::move(values)) {}

  using Any = std::variant<bool, long long, double, std::string, std::vector<double>>;
  const Any& any() const { return value_; }

private:
  Any value_;
};

/// {{"type", "point"}, {"position", {0, 2, 0}}, {"power_w", {40, 40, 40}}}
using Keys = std::vector<std::pair<std::string, Value>>;

/// A cloud in memory. The arrays are copied when they are added.
struct Points {
  std::size_t count = 0;
  const double* positions = nullptr; ///< [count x 3]
  const float* normals = nullptr;    ///< [count x 3], of any length above 0; null: they are estimated
  const float* colours =
      nullptr;                  ///< [count x 3], 0..1, sRGB unless the material's colour_space is "linear"; null: none
  const float* radii = nullptr; ///< [count], above 0; null: they are estimated
};

/// Nothing is loaded and no device is needed before a scene is prepared. A copy shares what it was copied from until
/// either is changed.
class Scene {
public:
  /// Nothing yet: no material, no object, no light.
  Scene();

  /// A scene file (.toml), or a cloud or mesh, around which a scene with one diffuse material, a camera and a light is
  /// made. `overrides`: as of set(). Throws Error(input), "file:line:column: key: expected ..., found ...", and
  /// Error(usage) for overrides that cannot be.
  static Scene from_file(const std::string& file, const std::vector<std::string>& overrides = {});

  /// The text of a scene file. The files that it names are relative to `folder`. Throws as from_file.
  static Scene from_text(const std::string& toml, const std::string& folder = ".");

  /// Adds a [[material]], [[shape]], [[light]] or [[cloud]], `kind` being "material", "shape", "light" or "cloud", with
  /// the keys that a scene file has for it.
  void add(const std::string& kind, const Keys& keys);

  /// Adds a [[cloud]] that is in memory; `keys`: those of a cloud but for `file`, at least {{"material", name}}.
  /// Throws Error(usage) where `count` is 0 or there are no positions.
  void add(const Points& points, const Keys& keys);

  /// Sets keys of a section that stands once: "render", "camera", "environment", "radiosity", "caustics", ...
  void set(const std::string& section, const Keys& keys);

  /// "key.path=value", as --set of the command line: "camera.fov_deg=30", "cloud.0.normals=flip". Throws Error(usage).
  void set(const std::string& assignment);

  /// "draft": a quarter of the samples a pixel and four times radiosity.epsilon; "normal"; "high": four times the
  /// samples and half of epsilon. `samples`: whether samples change, too. Throws Error(usage).
  void set_quality(const std::string& quality, bool samples = true);

  /// The same for light that is read at the points (Light::radiosity) and not by way of a picture: each point's direct
  /// light is the mean of 16, 64 or 256 samples, unless radiosity.light_samples says how many. Throws Error(usage).
  void set_bake_quality(const std::string& quality);

  /// Checks all that can be checked without loading clouds. Throws Error(input). Preparing a scene checks it, too.
  void check() const;

  struct Parts; ///< for the library itself
  const std::shared_ptr<Parts>& parts() const { return parts_; }

private:
  Parts& own();

  std::shared_ptr<Parts> parts_;
};

} // namespace pointgi::api
