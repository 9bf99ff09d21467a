// A process_factor integrated anew against the bare mechanization and against its own differences.
#include "core/smoother/repropagation.h"

#include <algorithm>

#include "core/inertial/strapdown/mechanization.h"
#include "smoother_rig.h"
#include "support/catch.h"
#include "window_rig.h"

namespace leonav {
namespace {

using namespace synthetic;
using namespace ekf_index;
using Eigen::Index;

// Two keyframes a second apart; the estimate of the first is displaced by `error`.
class Pair {
 public:
  Pair() : drive_(options()), repropagator_({drive_.config(), mems(), Drive::motion()}) {
    for (int i = 0; i < 3; ++i) feed(drive_.step(), drive_.lever_b(), &window_);
    before().state = keyframe().process_factor.from;
  }

  Keyframe& before() { return window_.at(1); }
  Keyframe& keyframe() { return window_.at(2); }
  const Repropagator& repropagator() const { return repropagator_; }

  void displace(Index i, double by) {
    EkfCorrection error = EkfCorrection::Zero(kSize + before().active.ambiguities);
    error(i) = by;
    add(error, true, &before().state);
  }
  NavState predicted() { return predicted_state(before(), keyframe()).nav; }
  NavState integrated() {
    Mechanization mechanization;
    mechanization.reset(before().state.nav, keyframe().sample_before_block);
    for (const ImuSample& sample : keyframe().block) mechanization.advance(sample);
    return mechanization.state();
  }
  void repropagation() { repropagator_(before(), &keyframe()); }

 private:
  static DriveOptions options() {
    DriveOptions options;
    options.noise = 0.1;
    return options;
  }

  Drive drive_;
  Window window_{3};
  Repropagator repropagator_;
};

double apart_m(const NavState& a, const NavState& b) { return (a.p_e - b.p_e).norm(); }

}  // namespace

TEST_CASE("a process factor whose start has turned away is integrated anew, a near one not") {
  Pair near;
  near.displace(kAttitude + 2, 5e-4);
  near.repropagation();
  CHECK(near.repropagator().repropagations() == 0);

  Pair far;
  far.displace(kAttitude, 0.1);
  far.displace(kAttitude + 2, 0.1);
  // What the first order leaves of 1 g tilted by 0.1 rad over a second.
  CHECK(apart_m(far.predicted(), far.integrated()) > 0.01);
  far.repropagation();
  CHECK(far.repropagator().repropagations() == 1);
  CHECK(apart_m(far.predicted(), far.integrated()) < 1e-5);
  CHECK((far.predicted().v_e - far.integrated().v_e).norm() < 1e-5);
  CHECK(far.predicted().q_eb.angularDistance(far.integrated().q_eb) < 1e-6);
  CHECK(process_error(far.before(), far.keyframe()).segment<3>(0).norm() >
        0.01);  // the estimate stays
  far.repropagation();
  CHECK(far.repropagator().repropagations() == 1);  // it begins there now
}

TEST_CASE("the Jacobian of a process factor that was integrated anew is the slope of its end") {
  Pair rig;
  rig.displace(kAttitude + 1, 0.1);
  rig.repropagation();
  REQUIRE(rig.repropagator().repropagations() == 1);
  const FilterState start = rig.before().state;
  const ProcessFactor process_factor = rig.keyframe().process_factor;
  for (Index j = kPosition; j < kGyroBias; ++j) {
    const double h = j < kAttitude ? 1.0 : 1e-3;
    const auto end = [&](double by) {
      rig.before().state = start;
      rig.displace(j, by);
      return rig.integrated();
    };
    const NavState up = end(h), down = end(-h);
    CAPTURE(j);
    const auto column = process_factor.F.col(j);
    // Sub-blocks of F take the specific force as constant.
    const double tolerance = 2e-3 * (1.0 + column.head(9).norm());
    CHECK(((up.p_e - down.p_e) / (2.0 * h) - column.segment<3>(kPosition)).norm() < tolerance);
    CHECK(((up.v_e - down.v_e) / (2.0 * h) - column.segment<3>(kVelocity)).norm() < tolerance);
  }
}

TEST_CASE("a heading that turns the whole window is repropagated by two factors a solve") {
  DriveOptions options;
  options.sigma_rpy = {0.02, 0.02, 0.3};
  Drive drive(options);
  const auto smoother = smoother_of(drive, 20);
  std::uint64_t before = 0, most = 0;
  int busy = 0;  // solves in which there was as much to be done
  for (int epoch = 0; epoch < 60; ++epoch) {
    solve(drive.step(), smoother.get());
    const std::uint64_t now = smoother->repropagations() - before;
    before = smoother->repropagations();
    most = std::max(most, now);
    busy += now == 2 ? 1 : 0;
  }
  CHECK(most == 2);
  CHECK(busy >= 5);
  // None of the window is left as it was.
  for (int k = 1; k < smoother->window().size(); ++k)
    CHECK_FALSE(
        is_far(smoother->window().at(k - 1).state, smoother->window().at(k).process_factor.from));
}

TEST_CASE("a block that is not whole leaves its process factor as it is") {
  Pair rig;
  rig.displace(kAttitude, 0.1);
  rig.keyframe().block_complete = false;
  const Eigen::MatrixXd F = rig.keyframe().process_factor.F;
  rig.repropagation();
  CHECK(rig.repropagator().repropagations() == 0);
  CHECK(Eigen::MatrixXd(rig.keyframe().process_factor.F) == F);
}

}  // namespace leonav
