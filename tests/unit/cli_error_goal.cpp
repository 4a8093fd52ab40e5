#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/instantiation/fineness.hpp>
#include <sunfleck/radiosity/fineness.hpp>

#include <sunfleck/solver/error_goal.hpp>

#include "cli/error_option.hpp"
#include "solver/refinement.hpp"

using namespace sunfleck;

namespace {

const std::vector<std::string> bands{"PAR", "NIR"};

std::vector<double> goal(const std::string& text) {
  return error_goal(wanted_errors(text), bands);
}

/// What a certificate says of errors, each known to a relative standard error of its square.
Certificate certificate(std::vector<double> rmse, double uncertainty) {
  Certificate c;
  c.rmse = std::move(rmse);
  for (const double e : c.rmse) c.square_standard_error.push_back(uncertainty * e * e);
  return c;
}

/// Two solves whose errors have nothing in common, compared by some organs.
SolveDifference apart(const std::vector<double>& a, const std::vector<double>& b, double uncertainty) {
  SolveDifference d;
  for (std::size_t k = 0; k < a.size(); ++k) {
    d.square.push_back(a[k] * a[k] + b[k] * b[k]);
    d.square_standard_error.push_back(uncertainty * d.square.back());
  }
  return d;
}

}  // namespace

TEST_CASE("a wanted error is a fraction or per cent, of all bands or of some", "[cli][error]") {
  CHECK(goal("0.02") == std::vector<double>{0.02, 0.02});
  CHECK(goal("2%") == std::vector<double>{0.02, 0.02});
  CHECK(goal("PAR=1%,NIR=0.025") == std::vector<double>{0.01, 0.025});
  CHECK(goal("NIR=3%") == std::vector<double>{0.0, 0.03});
}

TEST_CASE("a wanted error that cannot be read says what was found and expected", "[cli][error]") {
  const std::string range = "expected per cent, such as 2%, or a fraction, such as 0.02: from 0.0001 to 0.5";
  CHECK_THROWS_WITH(goal("2"), "--error: found '2'; " + range + " (did you mean 2%?)");
  CHECK_THROWS_WITH(goal("nan"), "--error: found 'nan'; " + range);
  CHECK_THROWS_WITH(goal(""), "--error: found ''; " + range);
  CHECK_THROWS_WITH(goal("1e-5"), "--error: found '1e-5'; " + range);
  CHECK_THROWS_WITH(goal("-1%"), "--error: found '-1%'; " + range);
  CHECK_THROWS_WITH(goal("2%%"), "--error: found '2%%'; " + range);
  CHECK_THROWS_WITH(goal("PAR=1%,2%"), "--error: found '2%'; expected BAND=ERROR, such as PAR=2%");
  CHECK_THROWS_WITH(goal("PAR=1%,"), "--error: found ''; expected BAND=ERROR, such as PAR=2%");
  CHECK_THROWS_WITH(goal("NER=1%"), "error: found band 'NER'; expected one of PAR, NIR (did you mean 'NIR'?)");
  CHECK_THROWS_WITH(goal("PAR=1%,PAR=2%"), "error: found band 'PAR' twice; expected each band once");
  CHECK_THROWS_AS(goal("2"), UsageError);
}

TEST_CASE("densities at the fineness of a quality are the quality's, and rise between and beyond", "[cli][error]") {
  const Quality known[] = {Quality::draft, Quality::standard, Quality::fine};
  for (int q = 0; q < 3; ++q) {
    const auto d = density_at(q), of = density_of(known[q]);
    CHECK(d.directions == of.directions);
    CHECK(d.lines_per_element == of.lines_per_element);
    CHECK(d.elements_per_organ == of.elements_per_organ);
    CHECK(d.sun_samples == of.sun_samples);
    CHECK(d.sun_lines_per_organ == of.sun_lines_per_organ);
    CHECK(d.tolerance == of.tolerance);
    const auto i = instantiation_density_at(q), of_i = instantiation_density(known[q]);
    CHECK(i.coarse.directions == of_i.coarse.directions);
    CHECK(i.fine.directions == of_i.fine.directions);
    CHECK(i.sun_lines_per_organ == of_i.sun_lines_per_organ);
  }
  for (double f = 0; f < 3; f += 0.25) {
    const auto a = density_at(f), b = density_at(f + 0.25);
    CHECK(a.directions * a.lines_per_element * a.elements_per_organ < b.directions * b.lines_per_element * b.elements_per_organ);
    CHECK(a.link_error > b.link_error);
    CHECK(instantiation_density_at(f).fine.lines_per_organ < instantiation_density_at(f + 0.25).fine.lines_per_organ);
    for (const char* method : {"clustering", "flat", "instantiation"}) CHECK(error_at(method, f) > error_at(method, f + 0.25));
  }
  CHECK(density_at(9).directions == density_at(finest_fineness).directions);
}

TEST_CASE("a solve that is good enough by a margin is the last", "[cli][error]") {
  Refinement r({0.05, 0.05}, "clustering");
  r.add(r.first(), certificate({0.02, 0.038}, 0.3), {});
  CHECK(r.reached());
  Refinement near({0.05, 0.05}, "clustering");
  near.add(near.first(), certificate({0.02, 0.048}, 0.3), {});  // below, but not by a standard error
  CHECK_FALSE(near.reached());
}

TEST_CASE("the next solve is as fine as the worst band needs, and no finer", "[cli][error]") {
  Refinement r({0.01, 0.02}, "clustering");
  r.add(r.first(), certificate({0.02, 0.05}, 0.2), {});
  CHECK_FALSE(r.reached());
  const double next = r.next(finest_fineness).value();
  CHECK(r.expected(1, next, Refinement::caution) <= Refinement::margin * 0.02);
  CHECK(r.expected(1, next - 0.06, Refinement::caution) > Refinement::margin * 0.02);
  CHECK(r.expected(0, next, Refinement::caution) <= Refinement::margin * 0.01);
  // of a band of which nothing is asked nothing is asked
  Refinement par({0.01, 0.0}, "clustering");
  par.add(par.first(), certificate({0.02, 0.05}, 0.2), {});
  CHECK(par.next(finest_fineness).value() < next);
}

TEST_CASE("an error that stays higher than expected takes another solve; the third is the last", "[cli][error]") {
  Refinement r({0.03}, "flat");
  r.add(r.first(), certificate({0.06}, 0.2), {});
  const double second = r.next(finest_fineness).value();
  REQUIRE(second < finest_fineness);
  r.add(second, certificate({0.04}, 0.1), {apart({0.06}, {0.04}, 0.1)});
  CHECK_FALSE(r.reached());
  const double third = r.next(finest_fineness).value();
  CHECK(third > second);
  r.add(third, certificate({0.035}, 0.02), {apart({0.06}, {0.035}, 0.1), apart({0.04}, {0.035}, 0.1)});
  CHECK_FALSE(r.reached());
  CHECK_FALSE(r.next(finest_fineness).has_value());
}

TEST_CASE("where nothing finer is left, there is no next solve", "[cli][error]") {
  Refinement r({0.0001}, "clustering");
  r.add(r.first(), certificate({0.05}, 0.2), {});
  CHECK(r.next(1.3).value() == 1.3);
  r.add(1.3, certificate({0.02}, 0.2), {apart({0.05}, {0.02}, 0.1)});
  CHECK_FALSE(r.next(1.3).has_value());
}

TEST_CASE("two solves tell an error that is below the noise of a certificate", "[cli][error]") {
  constexpr double coarse = 0.03;
  const double fine = coarse * error_at("clustering", 1.0);
  const auto found = [&](std::vector<SolveDifference> differences, double certified, double noise) {
    Refinement r({0.02}, "clustering");
    r.add(r.first(), certificate({coarse}, 0.2), {});
    Certificate second = certificate({certified}, 0.0);
    second.square_standard_error = {noise * noise};
    r.add(1.0, second, differences);
    return r;
  };
  // a certificate whose noise alone is twice the goal, and finds more than the goal
  const auto known = found({apart({coarse}, {fine}, 0.1)}, 0.022, 0.04);
  CHECK(known.reached());
  CHECK(known.expected(0, 1.0, 0.0) == Approx(fine).epsilon(0.15));  // errors that have something in common are allowed for
  // solves that are further apart than the first one's error explains
  CHECK_FALSE(found({apart({0.1}, {0.03}, 0.1)}, 0.01, 0.04).reached());
  // what both have wrong alike only the certificate shows
  CHECK_FALSE(found({apart({0.005}, {0.002}, 0.1)}, 0.025, 0.01).reached());
}

TEST_CASE("a solve has to be compared with every one before it", "[cli][error]") {
  Refinement r({0.01}, "clustering");
  r.add(r.first(), certificate({0.05}, 0.2), {});
  CHECK_THROWS_WITH(r.add(1.0, certificate({0.02}, 0.2), {}), "refinement: a solve is compared with every one before it");
}

TEST_CASE("what is said to be found lies within the certificate's interval, whatever two solves have wrong alike", "[cli][error]") {
  Refinement r({0.01}, "instantiation");
  Certificate coarse = certificate({0.075}, 0.05);
  coarse.rmse_low = {0.070}, coarse.rmse_high = {0.080};
  r.add(0.0, coarse, {});
  CHECK(r.found(0) == Approx(0.075));
  Certificate fine = certificate({0.0754}, 0.05);
  fine.rmse_low = {0.071}, fine.rmse_high = {0.081};
  r.add(1.0, fine, {apart({0.003}, {0.0015}, 0.05)});  // they agree with each other, not with the truth
  CHECK(r.found(0) >= 0.071);
  CHECK(r.found(0) <= 0.081);
  CHECK(r.expected(0, 1.0, 0.0) > 0.05);
  CHECK_FALSE(r.reached());
}
