/// The program keeps its promises at the extremes of truths.md §2.
#include "tests/support/extreme_scenes.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("the same scene at 1e-6 and 1e6 times the size is the same picture") {
  const Picture truth = render_text(ball_scene(1.0));
  CHECK(mean(truth, "R") > 0.02);
  for (const double s : {1e-6, 1e-3, 37.0, 1e6})
    CHECK(mean_difference(render_text(ball_scene(s)), truth) < 1e-4);
}

TEST_CASE("moved by a million times its size it is the same picture") {
  // Doubles leave 1e-10 of the size: what remains is the float rounding inside the root cube.
  CHECK(mean_difference(render_text(ball_scene(1.0, 3e6)), render_text(ball_scene(1.0))) < 1e-4);
}

TEST_CASE("the picture is linear in the light's power, from 1e-20 to 1e20") {
  const Picture truth = render_text(ball_scene(1.0));
  for (const double factor : {1e-20, 1e-7, 3.0, 1e20}) {
    const Picture picture = render_text(ball_scene(1.0, 0.0, 30.0 * factor));
    double most = 0.0;
    for (std::size_t i = 0; i < truth.channels.at("R").size(); ++i) {
      const double a = picture.channels.at("R")[i] / factor, b = truth.channels.at("R")[i];
      REQUIRE(std::isfinite(a));
      most = std::max(most, std::fabs(a - b) / (b + 1e-3));
    }
    CHECK(most < 1e-5);
  }
}

TEST_CASE("form, branching, capacity and depth do not change the picture, storage and groups not a bit of it",
          "[long]") {
  // By "fmm": which directions a point draws depends on its place in the order.
  const std::string scene = ball_scene(1.0) + "[radiosity]\nmethod = \"fmm\"\n";
  const auto with = [&](const std::vector<std::string>& settings) {
    return render_text(scene, [&](RenderOptions& o) { o.overrides = settings; });
  };
  const Picture truth = render_text(scene), step = with({"traversal.form=step"});
  for (const char* storage : {"traversal.storage=image1d_buffer", "traversal.storage=image2d"})
    CHECK(with({storage}).channels.at("R") == step.channels.at("R"));
  for (const char* form : {"step", "wide"})
    for (const char* grouping : {"ray", "packet"}) {
      if (std::string(form) == "step" && std::string(grouping) == "packet") continue;
      const auto in_groups = [&](const std::string& group) {
        return with({std::string("traversal.form=") + form, std::string("traversal.grouping=") + grouping,
                     "traversal.group=" + group});
      };
      const Picture whole = in_groups("8x4");
      CHECK(mean_difference(whole, truth) < 1e-4);
      for (const char* group : {"32x1", "64x1"}) { // another shape, and two pixels in one
        CAPTURE(form, grouping, group);
        CHECK(in_groups(group).channels == whole.channels);
      }
    }
  // Another tree adds the weights of blended splats in another order: rounding. Of one whose points stand in another
  // order other points may know their light (host/lights/shaft_light.h): as much as light over a disc is off its
  // gradient.
  for (const char* setting :
       {"traversal.form=step", "traversal.form=wide", "traversal.lanes=16", "octree.branching=4",
        "octree.leaf_capacity=4", "octree.max_depth=0", "octree.max_depth=1", "octree.max_depth=5"}) {
    CAPTURE(setting);
    CHECK(mean_difference(with({setting}), truth) < 5e-4);
    if (std::string(setting).find("octree.") == 0)
      CHECK(mean_difference(with({setting, "traversal.form=step"}), truth) < 5e-4);
  }
}

TEST_CASE("the absolute delta is a variant: small it agrees, large it jumps over surfaces", "[long]") {
  const Picture truth = render_text(ball_scene(1.0));
  const auto with_delta = [](const std::string& delta) {
    return render_text(ball_scene(1.0), [&](RenderOptions& o) {
      o.overrides = {"traversal.stepping=absolute_delta", "traversal.step_delta=" + delta};
    });
  };
  CHECK(mean_difference(with_delta("1e-5"), truth) < 5e-3);
  CHECK(mean_difference(with_delta("0.4"), truth) > mean_difference(with_delta("1e-5"), truth));
}

TEST_CASE("a window of the image is that part of the whole, and 1, 64 and odd sample counts work") {
  const Picture whole = render_text(ball_scene(1.0));
  const Picture part = render_text(ball_scene(1.0), [](RenderOptions& o) { o.pixel_bounds = "10,31,7,40"; });
  REQUIRE(part.width == 21);
  REQUIRE(part.height == 33);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      REQUIRE(part.channels.at("R")[static_cast<std::size_t>(y) * 21 + x] ==
              whole.channels.at("R")[static_cast<std::size_t>(y + 7) * 64 + x + 10]);
  for (const int spp : {1, 5, 64}) {
    const Picture picture = render_text(ball_scene(1.0), [&](RenderOptions& o) { o.spp = spp; });
    // One sample a pixel of a smooth picture: the mean is off by its edges only.
    CHECK(mean(picture, "R") == Approx(mean(whole, "R")).epsilon(0.05));
  }
  const Picture sliver = render_text(ball_scene(1.0), [](RenderOptions& o) { o.size = "1x4096"; });
  CHECK(sliver.height == 4096);
  CHECK(render_text(ball_scene(1.0), [](RenderOptions& o) { o.size = "1x1"; }).width == 1);
}

TEST_CASE("a seed gives the same bits again, another seed other ones") {
  const Picture a = render_text(ball_scene(1.0)), b = render_text(ball_scene(1.0));
  const Picture c = render_text(ball_scene(1.0), [](RenderOptions& o) { o.seed = 2; });
  CHECK(a.channels.at("R") == b.channels.at("R"));
  CHECK(a.channels.at("R") != c.channels.at("R"));
}

TEST_CASE("lights on a surface and in the camera give finite pixels") {
  const std::string light = GENERATE("position = [0.0, 0.0, 0.0]", "position = [0.0, 1.0, 0.0]",
                                     "position = [0.3, 1.2, 3.0]", "position = [0.0, 0.5, 0.0]");
  const Picture picture =
      render_text(ball_scene(1.0) + "[[light]]\ntype = \"point\"\n" + light + "\npower_w = [9.0, 9.0, 9.0]\n");
  for (const float value : picture.channels.at("R"))
    REQUIRE(std::isfinite(value));
}

TEST_CASE("ten thousand lights are as bright as their sum") {
  std::string lights;
  for (int i = 0; i < 10'000; ++i)
    lights += "[[light]]\ntype = \"point\"\nposition = [" + number(0.7 + 1e-9 * i) +
              ", 1.9, 0.8]\npower_w = [0.003, 0.003, 0.003]\n";
  const Picture picture = render_text(ball_scene(1.0, 0.0, 0.0) + lights);
  // All in one place: what one light of 30 W gives, whichever of them a sample draws. The one needs no shadow rays, and
  // over a disc follows its gradient (host/lights/shaft_light.h): 2e-3.
  CHECK(mean_difference(picture, render_text(ball_scene(1.0))) < 3e-3);
}

TEST_CASE("an outlier at a million times the size, bad points, a pile of points: the picture of the clean cloud") {
  const Picture truth = render_ply(sphere_ply(4000, {}));
  CHECK(mean(truth, "A") > 0.1);
  SECTION("an outlier") {
    CHECK(mean_difference(render_ply(sphere_ply(4000, {"1e6 0 0 1 0 0"})), truth) < 1e-4);
  }
  SECTION("points that are no points") {
    const std::vector<std::string> bad = {"nan 0 0 1 0 0", "0 inf 0 1 0 0", "0 0 0.5 0 0 0", "0 0 0.2 nan 0 0"};
    CHECK(render_ply(sphere_ply(4000, bad)).channels.at("R") == truth.channels.at("R"));
  }
  SECTION("a hundred thousand points in one place, behind the sphere's middle") {
    const std::vector<std::string> pile(100'000, "0 0 0 0 0 1");
    // They are inside the sphere and cannot be seen; the sphere's own splats stay as they are.
    CHECK(mean_difference(render_ply(sphere_ply(4000, pile)), truth) < 0.02);
  }
}

TEST_CASE("clouds of one, two, three and coincident points give a picture") {
  const std::string points = GENERATE("0 0 0 0 0 1\n", "0 0 0 0 0 1\n1 0 0 0 0 1\n",
                                      "0 0 0 0 0 1\n1 0 0 0 0 1\n2 0 0 0 0 1\n", "0 0 0 0 0 1\n0 0 0 0 0 1\n");
  const auto count = std::count(points.begin(), points.end(), '\n');
  const Picture picture = render_ply(
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty "
      "float nz\nend_header\n" +
      points);
  CHECK(mean(picture, "A") > 0.0);
}
