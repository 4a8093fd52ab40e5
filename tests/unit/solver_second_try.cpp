// Which method comes after one that its certificate contradicts.
#include <catch2/catch.hpp>

#include "solver/second_try.hpp"

using namespace sunfleck;

namespace {

const auto everything_fits = [](const MethodChoice&, std::string&) { return true; };

}  // namespace

TEST_CASE("after instantiation clustering, after that finer, then none", "[solver][second_try]") {
  const RunSettings run;
  SecondTry tries(run, everything_fits);
  const auto second = tries.next({"instantiation", Quality::standard, ""});
  REQUIRE(second);
  CHECK(second->method == "clustering");
  CHECK(fineness_of(*second) == 1.0);
  const auto third = tries.next(*second);
  REQUIRE(third);
  CHECK(third->method == "clustering");
  CHECK(fineness_of(*third) == 2.0);
  CHECK_FALSE(tries.next(*third));
  CHECK(tries.advice().find("reference") != std::string::npos);
  SecondTry finest(run, everything_fits);
  MethodChoice choice{"clustering", Quality::standard, ""};
  choice.fineness = 3.0;
  CHECK_FALSE(finest.next(choice));
}

TEST_CASE("a method that was asked for is kept, and what to ask for is said", "[solver][second_try]") {
  RunSettings run;
  run.method = "instantiation";
  SecondTry tries(run, everything_fits);
  CHECK_FALSE(tries.next({"instantiation", Quality::standard, ""}));
  CHECK(tries.advice() ==
        "Method 'instantiation' was asked for and is kept: leave the choice to the program, or ask for clustering or reference");
}

TEST_CASE("what does not fit into memory is not tried", "[solver][second_try]") {
  const RunSettings run;
  SecondTry nothing(run, [](const MethodChoice&, std::string& why) {
    why = "needs about 9 GiB, 2 GiB of the machine are free";
    return false;
  });
  CHECK_FALSE(nothing.next({"instantiation", Quality::draft, ""}));
  CHECK(nothing.advice() == "Method clustering would be nearer to the truth, but needs about 9 GiB, 2 GiB of the machine are free");
}

TEST_CASE("what stays closed is known to instantiation alone", "[solver][second_try]") {
  RunSettings run;
  run.depth.only = {"tile[3]/*"};
  SecondTry tries(run, everything_fits);
  CHECK_FALSE(tries.next({"instantiation", Quality::standard, ""}));
}
