#include "host/scene/shares.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace pointgi;

namespace {

struct Entry {
  double weight;
  float cumulative;
};

std::vector<Entry> shared(const std::vector<double>& weights) {
  std::vector<Entry> entries;
  for (const double w : weights)
    entries.push_back({w, 0.0f});
  accumulate_shares(entries, [](const Entry& e) { return e.weight; });
  return entries;
}

float share(const std::vector<Entry>& entries, std::size_t i) {
  return entries[i].cumulative - (i > 0 ? entries[i - 1].cumulative : 0.0f);
}

} // namespace

TEST_CASE("shares are those of the weights") {
  const auto entries = shared({1.0, 0.0, 2.0, 5.0});
  CHECK(entries[0].cumulative == 0.125f);
  CHECK(entries[1].cumulative == 0.125f);
  CHECK(entries[2].cumulative == 0.375f);
  CHECK(entries[3].cumulative == 1.0f);
  CHECK(shared({}).empty());
}

TEST_CASE("an entry is chosen as often as its share says, even the smallest") {
  // Random numbers are multiples of 2^-24: a share between two of them would be chosen more or less often than it is.
  const auto entries = shared({1.5, 0.7, 3.2, 1e7, 2.5, 1.1});
  for (const Entry& e : entries)
    CHECK(std::fmod(double{e.cumulative}, smallest_share) == 0.0);
  for (std::size_t i = 0; i < entries.size(); ++i)
    CHECK(share(entries, i) > 0.0f);
}

TEST_CASE("of very many equal entries no part is left out") {
  const std::vector<Entry> entries = shared(std::vector<double>(20'000'000, 1.0));
  for (std::size_t part = 1; part <= 20; ++part)
    CHECK(entries[part * 1'000'000 - 1].cumulative == Approx(0.05 * static_cast<double>(part)).epsilon(1e-6));
}

TEST_CASE("the dimmest of millions has a share") {
  // Before, between and behind bright ones: a float near 1 cannot tell shares of 1e-12 apart.
  std::vector<double> weights;
  for (int i = 0; i < 2'000'000; ++i)
    weights.push_back(i % 1000 == 7 ? 1.0 : i % 5 == 0 ? 0.0 : 1e-9);
  const auto entries = shared(weights);
  double difference = 0.0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const float of_entry = share(entries, i);
    if (weights[i] > 0.0)
      REQUIRE(of_entry >= smallest_share);
    else
      REQUIRE(of_entry == 0.0f);
    if (weights[i] == 1.0) difference += std::abs(2000.0 * double{of_entry} - 1.0) / 2000.0;
  }
  CHECK(entries.back().cumulative == 1.0f);
  CHECK(difference < 0.15); // 1.6 million of the smallest shares are 9.5 % of all, which the bright ones give
}
