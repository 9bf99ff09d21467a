// What a solve that was not taken leaves behind: nothing. And no allocation.
#include <cstring>

#include "smoother_rig.h"
#include "support/catch.h"
#include "tools/common/allocations/allocation_counter.h"

namespace leonav {
namespace {

using namespace synthetic;

bool same(const FilterState& a, const FilterState& b) {
  return difference(a, b).cwiseAbs().maxCoeff() == 0.0 &&
         (a.nav.q_eb.coeffs() - b.nav.q_eb.coeffs()).cwiseAbs().maxCoeff() == 0.0;
}

// Bit for bit: states and factors.
void check_same(const Window& a, const Window& b) {
  REQUIRE(a.size() == b.size());
  for (int k = 0; k < a.size(); ++k) {
    CAPTURE(k);
    CHECK(same(a.at(k).state, b.at(k).state));
    CHECK(a.at(k).weights_decided == b.at(k).weights_decided);
    REQUIRE(a.at(k).measurements.size() == b.at(k).measurements.size());
    for (std::size_t m = 0; m < a.at(k).measurements.size(); ++m) {
      CHECK(a.at(k).measurements[m].factor == b.at(k).measurements[m].factor);
    }
  }
}

DriveOptions robust_drive() {
  DriveOptions options;
  options.robust = true;
  options.arc_epochs = 15;
  options.edit = [](int epoch, MeasurementEpoch* measured) {
    if (epoch % 4 == 0) measured->measurements[0].value += 12.0;  // a code, four sigma
  };
  return options;
}

}  // namespace

TEST_CASE("a solve that is not taken has not happened") {
  Drive drive(robust_drive());
  const auto with = smoother_of(drive, 8), without = smoother_of(drive, 8);
  for (int epoch = 1; epoch <= 30; ++epoch) {
    CAPTURE(epoch);
    const KeyframeInput& input = drive.step();
    if (epoch % 3 == 0) {
      Unlimited unlimited;
      Stingy stingy;
      with->add(input);
      with->solve(epoch % 2 == 0 ? static_cast<SolveBudget*>(&unlimited) : &stingy);
      // The next keyframe may come before it is known what has become of this one's result.
      if (epoch % 9 != 0) with->commit_or_roll_back(false);
      without->add(input);
      if (epoch % 9 != 0) check_same(with->window(), without->window());
      continue;
    }
    const SmootherResult a = solve(input, with.get()), b = solve(input, without.get());
    CHECK(a.iterations == b.iterations);
    CHECK((a.state.p_e - b.state.p_e).norm() == 0.0);
    CHECK((a.covariance - b.covariance).norm() == 0.0);
    check_same(with->window(), without->window());
  }
}

TEST_CASE("a solve that is taken has happened") {
  Drive drive(robust_drive());
  const auto with = smoother_of(drive, 8), without = smoother_of(drive, 8);
  for (int epoch = 1; epoch <= 6; ++epoch) {
    const KeyframeInput& input = drive.step();
    solve(input, with.get());
    solve(input, without.get(), false);
  }
  CHECK_FALSE(same(with->window().newest().state, without->window().newest().state));
}

TEST_CASE("the smoother allocates when constructed, not after") {
  DriveOptions options = robust_drive();
  const auto edit = options.edit;
  options.edit = [edit](int epoch, MeasurementEpoch* measured) {
    edit(epoch, measured);
    if (epoch == 20) remove_satellites([](SatelliteId) { return true; }, measured);
    if (epoch == 30) measured->measurements[3].sigma = 0.0;
  };
  Drive drive(options);
  const auto smoother = smoother_of(drive, 10);
  std::size_t allocations = 0;
  int failures = 0;
  for (int epoch = 1; epoch <= 40; ++epoch) {
    KeyframeInput input = drive.step();
    if (epoch == 25) input.process.noise.diagonal().array() -= 1e12;
    if (epoch == 35) input.follows_previous = false;
    start_counting_allocations();
    const SmootherResult result = solve(input, smoother.get(), epoch % 7 != 0);
    allocations += stop_counting_allocations();
    failures += result.status == SmootherStatus::kOk ? 0 : 1;
  }
  CHECK(allocations == 0);
  CHECK(failures >= 3);
}

}  // namespace leonav
