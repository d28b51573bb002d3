/// The area that a setting adds to a trade, against counting the cells of a fine grid.
#include "host/measure/front_gain.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace pointgi;

namespace {

constexpr int cells = 400; // an axis, over the logarithms 0 to 4

bool holds(const TradePoint& point, double x, double y) {
  return std::log(point.seconds) <= x && std::log(point.error) <= y;
}

/// The share of the cells that `point` leaves behind it and no other does, times the area of all.
double counted(const TradePoint& point, const std::vector<TradePoint>& others) {
  int count = 0;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const double x = 4.0 * (i + 0.5) / cells, y = 4.0 * (j + 0.5) / cells;
      bool taken = !holds(point, x, y);
      for (const TradePoint& other : others)
        taken = taken || holds(other, x, y);
      count += taken ? 0 : 1;
    }
  return 16.0 * count / (double{cells} * cells);
}

} // namespace

TEST_CASE("the area that is gained is that of a count") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0.0, 4.0);
  const auto draw = [&] { return TradePoint{std::exp(place(random)), std::exp(place(random))}; };
  const TradePoint worst{std::exp(4.0), std::exp(4.0)};
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<TradePoint> others;
    for (int i = 0; i < trial % 8; ++i)
      others.push_back(draw());
    const TradePoint point = draw();
    // A row and a column of cells may fall on either side, at each step of the front.
    CHECK(area_gained(point, others, worst) == Approx(counted(point, others)).margin(0.1));
  }
}

TEST_CASE("what another beats in both gains nothing, and is behind by the lesser factor") {
  const std::vector<TradePoint> others{{1.0, 4.0}, {2.0, 1.0}};
  CHECK(area_gained({3.0, 2.0}, others, {10.0, 10.0}) == 0.0);
  CHECK(behind({3.0, 2.0}, others) == Approx(std::log(1.5)));
  CHECK(area_gained({2.0, 1.0}, others, {10.0, 10.0}) == 0.0);
  CHECK(behind({2.0, 1.0}, others) == 0.0);
  CHECK(area_gained({1.0, 1.0}, others, {10.0, 10.0}) == Approx(std::log(2.0) * std::log(4.0)));
  CHECK(behind({1.0, 0.5}, others) == Approx(-std::log(2.0)));
  CHECK(behind({1.0, 1.0}, {}) < 0.0);
}
