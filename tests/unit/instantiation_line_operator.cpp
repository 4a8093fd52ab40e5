// Lines of an operator: kept as rows, or shown to a visitor.
#include <catch2/catch.hpp>

#include <cmath>

#include <tbb/global_control.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/radiosity/solve.hpp>

#include "instantiation/inside_gather.hpp"
#include "instantiation/local_solve.hpp"
#include "reference_runs.hpp"

using namespace sunfleck;

namespace {

/// Light that differs from side to side.
LaneField<2> light_of(std::size_t sides) {
  RandomStream random(5);
  LaneField<2> out(sides);
  for (auto& x : out)
    for (std::size_t k = 0; k < 2; ++k) x[k] = static_cast<float>(random.next());
  return out;
}

}  // namespace

TEST_CASE("an operator's lines give the same light followed at once as kept in rows, for any number of threads") {
  auto scene = reference_runs::scene_with({"PAR"}, {uniform_optics("leaf", {0.4}, {0.4})});
  reference_runs::add(scene, "crown", reference_runs::leaves(200, 0.3, {1, 1, 1}, 3), 0);
  const FacetScene facets = expand(scene);
  RadiositySettings settings;
  settings.density = density_of(Quality::standard);
  const Elements elements = make_elements(scene, facets, settings);
  const OperatorDensity density{40, 5.0, 4, 1};
  for (const auto seen : {LineOperator::Seen::elements, LineOperator::Seen::cells}) {
    const auto light = light_of(2 * (seen == LineOperator::Seen::cells ? elements.surface.cells() : elements.size()));
    const LineOperator kept(elements, {}, density, 7, silent(), seen);
    LaneField<2> from_rows(2 * elements.size(), Lanes<2>{}), followed[2];
    add_inside<2>(kept, light, from_rows);
    for (const std::size_t threads : {1, 3}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      InsideGather<2> gather(elements, light, seen);
      const LineOperator shown(elements, {}, density, 7, silent(), seen, &gather);
      CHECK(shown.inside.size() == 0);
      CHECK(shown.lines == kept.lines);
      CHECK((shown.outside == kept.outside));
      CHECK(shown.points == kept.points);
      CHECK(shown.bytes() < kept.bytes());
      followed[threads > 1] = gather.mean(shown);
    }
    double worst = 0, most = 0;
    bool same = true;
    for (std::size_t i = 0; i < from_rows.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k) {
        worst = std::max(worst, std::fabs(double{followed[0][i][k]} - from_rows[i][k]));
        most = std::max(most, double{from_rows[i][k]});
        same = same && followed[0][i][k] == followed[1][i][k];
      }
    CHECK(most > 0.1);
    CHECK(worst < 1e-5 * most);  // sums of some hundred single-precision values, in another order
    CHECK(same);
  }
}
