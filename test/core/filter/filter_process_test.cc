#include "core/filter/state/filter_process.h"

#include "support/catch.h"

using namespace leonav;

namespace {

// Two states then, the second of which has walked since.
FilterProcess two_ambiguities() {
  FilterProcess process;
  process.begin(2);
  process.noise(1, 1) = 0.04;
  return process;
}

}  // namespace

TEST_CASE("two ambiguities that were there then are joined by a factor of their own") {
  FilterProcess process = two_ambiguities();
  process.transition.rightCols<1>() << 0.5, 0.2;  // the updates have moved both
  process.join(0, 1, 3.0, 0.01);
  REQUIRE(process.joins.size() == 1);
  CHECK(process.joins[0].from == 0);
  CHECK(process.joins[0].to == 1);
  CHECK(process.joins[0].innovation_m == Approx(3.3));
  CHECK(process.joins[0].variance == Approx(0.05));
  CHECK(process.transition.leftCols(2).isIdentity(0.0));
}

TEST_CASE("a state that was removed since is found by its column") {
  FilterProcess process;
  process.begin(3);
  process.remove(0);
  process.join(0, 1, 1.0, 0.01);
  REQUIRE(process.joins.size() == 1);
  CHECK(process.joins[0].from == 1);
  CHECK(process.joins[0].to == 2);
}

TEST_CASE("an ambiguity that has started since goes on from the one it is joined to") {
  FilterProcess process = two_ambiguities();
  process.append(1e4);
  process.transition.rightCols<1>() << 0.5, 0.2, 7.0;
  process.join(1, 2, 3.0, 0.01);
  CHECK(process.joins.empty());
  CHECK(process.transition(2, 1) == 1.0);
  CHECK(process.transition(2, 2) == Approx(3.2));
  CHECK(process.noise(2, 2) == Approx(0.05));
  process.remove(1);
  CHECK(process.transition(1, 1) == 1.0);
  CHECK(process.noise(1, 1) == Approx(0.05));
  CHECK(process.noise(0, 1) == 0.0);
}

TEST_CASE("a new recording has no joins") {
  FilterProcess process = two_ambiguities();
  process.join(0, 1, 3.0, 0.01);
  process.begin(2);
  CHECK(process.joins.empty());
}
