#include "host/scene/objects.h"

namespace pointgi {

namespace {

/// What a shape is called and how it is turned.
struct ShapeWords {
  const char* type;
  std::string how_to_turn;
};

std::string other_side(bool inward) {
  return std::string("set inward = ") + (inward ? "false" : "true");
}

ShapeWords words_of(const QuadShape&) {
  return {"quad", "swap edge_u and edge_v"};
}
ShapeWords words_of(const DiscShape&) {
  return {"disc", "reverse its normal"};
}
ShapeWords words_of(const SphereShape& shape) {
  return {"sphere", other_side(shape.inward)};
}
ShapeWords words_of(const BoxShape& shape) {
  return {"box", other_side(shape.inward)};
}
ShapeWords words_of(const CylinderShape& shape) {
  return {"cylinder", other_side(shape.inward)};
}

} // namespace

SceneObject object_of(const Scene& scene, std::size_t object) {
  if (object < scene.clouds.size()) {
    const CloudSettings& cloud = scene.clouds[object];
    const std::string name = "cloud." + std::to_string(object);
    return {name + " (" + cloud.file + ")",
            "--set " + name + ".normals=" + (cloud.normals == NormalSource::flip ? "auto" : "flip") + " turns it",
            cloud.material, true};
  }
  const std::size_t number = object - scene.clouds.size();
  const ShapeSettings& shape = scene.shapes[number];
  const ShapeWords words = std::visit([](const auto& geometry) { return words_of(geometry); }, shape.geometry);
  return {"shape." + std::to_string(number) + " (" + words.type + ", " + shape.place.text() + ")", words.how_to_turn,
          shape.material, false};
}

} // namespace pointgi
