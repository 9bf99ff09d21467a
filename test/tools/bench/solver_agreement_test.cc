// The comparison of both solvers counts what one of them cannot solve.
#include "tools/bench/solver_agreement.h"

#include <memory>

#include "core/smoother/drive_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr int kCapacity = 4;

// A window of three keyframes. With `later` nothing tells of the oldest one's position but what
// comes after it: as a whole the window has a minimum, its forward pass has no first step.
Window window_of(bool later) {
  DriveOptions options;
  Drive drive(options);
  Window window(kCapacity);
  window.start(drive.step());
  const auto keyframe = std::make_unique<KeyframeInput>(drive.step());
  REQUIRE(window.append(*keyframe));
  for (int i = 0; i < 2; ++i) REQUIRE(window.append(drive.step()));
  WindowPrior prior = window.prior();
  RtsSolver chain(2 * kCapacity);
  REQUIRE(chain.marginalize_oldest(window, drive.lever_b(), &prior));
  if (later) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      prior.information.row(i).setZero();
      prior.information.col(i).setZero();
      prior.gradient(i) = 0.0;
    }
    window.at(1).measurements.clear();
  }
  window.drop_oldest(prior);
  return window;
}

}  // namespace

TEST_CASE("a window that both solve is compared, state by state of every keyframe") {
  SolverAgreement agreement(DriveOptions{}.lever_b, kCapacity);
  CHECK(agreement.add(window_of(false)));
  CHECK(agreement.counts().windows == 1);
  CHECK(agreement.counts().only_chain + agreement.counts().only_ceres == 0);
  CHECK(agreement.counts().most_sigmas > 0.0);
  CHECK_NOTHROW(agreement.require());
}

TEST_CASE("a window that Ceres solves and the chain does not is counted, and is a failure") {
  SolverAgreement agreement(DriveOptions{}.lever_b, kCapacity);
  CHECK(agreement.add(window_of(true)));
  CHECK(agreement.counts().windows == 1);
  CHECK(agreement.counts().only_ceres == 1);
  CHECK_THROWS_WITH(agreement.require(), Catch::Contains("one solver has found a minimum"));
}

}  // namespace leonav
