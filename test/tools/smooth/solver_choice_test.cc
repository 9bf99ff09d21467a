// Which solver leonav-smooth takes by itself, and that it says why.
#include "tools/smooth/solver_choice.h"

#include "support/catch.h"

namespace leonav::test {

using Catch::Contains;

TEST_CASE("Ceres is chosen where it needs at most half of the free memory") {
  const SolverChoice fits = choose_solver(1'000'000, 4.1e9);
  CHECK(fits.name == "ceres");
  CHECK_THAT(fits.reason, Contains("1000000 measurements") && Contains("some 2.0 GB") &&
                              Contains("4.1 GB are free"));
  const SolverChoice tight = choose_solver(1'000'000, 3.9e9);
  CHECK(tight.name == "chain");
  CHECK_THAT(tight.reason, Contains("3.9 GB are free") && Contains("at most half"));
  CHECK(choose_solver(1'000'000, std::nullopt).name == "ceres");
}

TEST_CASE("for a log of more than three million measurements the chain is chosen") {
  CHECK(choose_solver(3'000'000, 1e12).name == "ceres");
  const SolverChoice long_one = choose_solver(3'000'001, 1e12);
  CHECK(long_one.name == "chain");
  CHECK_THAT(long_one.reason, Contains("more than 3000000 measurements"));
}

TEST_CASE("the system tells how much memory is free") {
  const auto free = available_memory();
  REQUIRE(free);
  CHECK(*free > 1e6);
  CHECK(*free < 1e15);
}

}  // namespace leonav::test
