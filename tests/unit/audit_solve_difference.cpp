#include <catch2/catch.hpp>

#include <sunfleck/audit/solve_difference.hpp>
#include <sunfleck/core/error.hpp>

using namespace sunfleck;

namespace {

/// Two states, two bands, organs 3, 5, 8, of areas 1, 2, 1 m^2, whose light per area is `light` (state, organ, band).
OrganTotals solve(auto light) {
  OrganTotals t(2, 2, {3, 5, 8});
  t.area = {1, 2, 1};
  t.plant_area = 4;
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t b = 0; b < 2; ++b) {
        const double power = t.area[k] * light(s, k, b);
        t.absorbed[(s * 3 + k) * 2 + b] = b == 0 ? power : 0.0;  // the second band is not absorbed
        t.irradiance[((s * 3 + k) * 2 + 1) * 2 + b] = power;
        t.plant_absorbed[s * 2 + b] += b == 0 ? power : 0.0;
        t.plant_irradiance[s * 2 + b] += power;
      }
  return t;
}

const std::vector<ChosenOrgan> all{{3, 0.25, 1, true}, {5, 0.5, 2, true}, {8, 0.25, 1, true}};

std::vector<std::vector<Balance>> balance() {
  Balance absorbed, passed;
  absorbed.incident = passed.incident = 100;
  absorbed.leaves = 40;
  return {{absorbed, passed}, {absorbed, passed}};
}

}  // namespace

TEST_CASE("solves that differ by a tenth of the mean everywhere are a tenth apart", "[audit]") {
  const auto fine = solve([](auto, auto, auto b) { return b == 0 ? 10.0 : 50.0; });
  const auto coarse = solve([](auto, auto k, auto b) { return (b == 0 ? 10.0 : 50.0) * (k == 1 ? 1.1 : 0.9); });
  const auto d = solve_difference(all, coarse, fine, balance());
  CHECK(d.square[0] == Approx(0.01));
  CHECK(d.square[1] == Approx(0.01));                           // by irradiance, where nothing is absorbed
  CHECK(d.square_standard_error == std::vector<double>{0, 0});  // all organs are compared
}

TEST_CASE("squares are means over states, weighted by the area that an organ stands for", "[audit]") {
  const auto fine = solve([](auto, auto, auto) { return 10.0; });
  const auto coarse = solve([](auto s, auto k, auto) { return s == 1 && k == 1 ? 12.0 : 10.0; });
  CHECK(solve_difference(all, coarse, fine, balance()).square[0] == Approx(0.5 * 0.5 * 0.04));
  CHECK(solve_difference(all, fine, fine, balance()).square[0] == 0.0);
}

TEST_CASE("organs drawn by chance leave an uncertainty", "[audit]") {
  auto drawn = all;
  for (auto& c : drawn) c.certain = false;
  const auto fine = solve([](auto, auto, auto) { return 10.0; });
  const auto coarse = solve([](auto, auto k, auto) { return k == 1 ? 12.0 : 10.0; });
  // squares .04, 0, 0 with shares .5, .25, .25 about a mean of .02: n / (n - 1) sum (share d)^2
  CHECK(solve_difference(drawn, coarse, fine, balance()).square_standard_error[0] == Approx(std::sqrt(1.5 * (0.25 + 2 * 0.0625)) * 0.02));
}

TEST_CASE("solves without the organs to compare are refused", "[audit]") {
  const auto t = solve([](auto, auto, auto) { return 10.0; });
  CHECK_THROWS_AS(solve_difference({{4, 1, 1, true}}, t, t, balance()), Error);
}
