// Two views of a saddle of points under a lamp and beside a red ball; the light is solved once.
#include <cstdio>
#include <numeric>
#include <pointgi/pointgi.h>

int main() {
  // A cloud from arrays: 50 x 50 points of a saddle. Radii are left out and found by the library.
  std::vector<double> positions;
  std::vector<float> normals;
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 50; ++j) {
      const double x = i / 32.0 - 0.75, z = j / 32.0 - 0.75;
      positions.insert(positions.end(), {x, 0.25 * x * z, z});
      normals.insert(normals.end(), {0.0f, 1.0f, 0.0f});
    }
  try {
    pointgi::Scene scene; // the keys are those of scene files
    scene.add("material", {{"name", "white"}, {"type", "diffuse"}, {"albedo", {0.7, 0.7, 0.7}}});
    scene.add("material", {{"name", "red"}, {"type", "diffuse"}, {"albedo", {0.8, 0.1, 0.1}}});
    scene.add({2500, positions.data(), normals.data()}, {{"material", "white"}});
    scene.add("shape",
              {{"type", "sphere"}, {"centre", {0, 0.4, 0}}, {"radius", 0.25}, {"spacing", 0.03}, {"material", "red"}});
    scene.add("light", {{"type", "point"}, {"position", {0.5, 2, 0.5}}, {"power_w", {40, 40, 40}}});

    const pointgi::RunControl run{{}, {}, [](pointgi::LogLevel, const std::string& text) { std::puts(text.c_str()); }};
    const pointgi::Prepared prepared(pointgi::Context(), scene, run); // on a GPU if there is one
    const pointgi::Light light(prepared, {}, run);
    for (const char* name : {"left", "right"}) {
      pointgi::FilmOptions view;
      view.camera = pointgi::Camera{{*name == 'l' ? -2.0 : 2.0, 1.5, 2.0}, {0.0, 0.1, 0.0}};
      view.width = 80, view.height = 60, view.spp = 16;
      const pointgi::Film film(light, view, run);
      film.write_exr(std::string(name) + ".exr");
      const std::vector<float>& green = film.channel("G"); // a value a pixel, rows downwards
      std::printf("%s: mean of green %.9g\n", name, std::accumulate(green.begin(), green.end(), 0.0) / (80 * 60));
    }
  } catch (const pointgi::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
