// StateEstimate's operations on the covariance, against the textbook's formulas for one
// measurement.
#include "core/filter/estimate/state_estimate.h"

#include "core/earth/rotation.h"
#include "core/filter/estimate/inertial_propagator.h"
#include "support/catch.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;

FilterState turning_filter_state() {
  FilterState state;
  state.nav.time = synthetic::kStart;
  state.nav.p_e = synthetic::start_position();
  const Eigen::Matrix3d C_en = synthetic::C_en_at(state.nav.p_e);
  state.nav.q_eb = Eigen::Quaterniond(C_en * rotation_from_euler({0.1, -0.2, 2.1}));
  state.nav.v_e = C_en * Vector3d{9.0, -14.0, 0.5};
  return state;
}

// The estimate that starts as certain and coasts for a second.
StateEstimate after_a_second(const EkfConfig& config, const FilterState& state) {
  StateEstimate estimate(config);
  InertialPropagator propagator(config, synthetic::mems());
  estimate.set_exactly(state, true);
  propagator.restart(state.nav, ImuSample());
  CHECK_FALSE(propagator.predict({}, synthetic::kStart.plus_seconds(1.0), &estimate));
  return estimate;
}

TEST_CASE(
    "a constraint's innovation and variance are the prediction's, and the residual is what the "
    "update left") {
  StateEstimate estimate = after_a_second(EkfConfig(), turning_filter_state());
  const auto& P = estimate.covariance();
  MotionMeasurements two(2);
  for (std::size_t i = 0; i < 2; ++i) {
    two[i].component = static_cast<int>(i);
    two[i].residual = i == 0 ? 0.1 : 1e3;  // the second far beyond the gate
    two[i].variance = 0.01;
    two[i].row(kVelocity + static_cast<int>(i)) = 1.0;
  }
  const double prior = P(kVelocity, kVelocity), variance = prior + 0.01;
  CHECK(estimate.constrain(&two, 4.0) == 1);
  CHECK(two[0].used);
  CHECK(two[0].innovation == 0.1);
  CHECK(two[0].innovation_variance == Approx(variance));
  CHECK(two[0].left == Approx(0.1 * 0.01 / variance));
  CHECK(P(kVelocity, kVelocity) == Approx(prior * 0.01 / variance));
  CHECK_FALSE(two[1].used);
  CHECK(two[1].innovation == Approx(1e3).margin(0.1));  // the first has changed the state
}

TEST_CASE("a vehicle constant that joins later gets its own state and leaves all else as it is") {
  EkfConfig config;
  config.keep_process = true;
  config.vehicle = {2, {0.02, 0.02, 0.03}, {1e-5, 1e-5, 1e-6}};
  FilterState state = turning_filter_state();
  state.vehicle = {0.01, 0.02};
  StateEstimate estimate = after_a_second(config, state);
  for (std::size_t i = 0; i < 3; ++i) {
    Ambiguity ambiguity;
    ambiguity.value_m = 10.0 + double(i);
    estimate.add_ambiguity(ambiguity, 1.0);
  }
  MotionMeasurements known(1);  // so that states are correlated
  known[0].variance = 1.0;
  known[0].row.setOnes();
  estimate.constrain(&known, 1e9);
  CHECK(estimate.process().continuous);
  const StateEstimate before = estimate;

  estimate.add_vehicle_constants(kOdometerScale);
  const auto& P = estimate.covariance();
  const auto& Q = before.covariance();
  constexpr int kNew = kSize + kOdometerScale;
  REQUIRE(P.rows() == Q.rows() + 1);
  REQUIRE(estimate.state().vehicle.size() == 3);
  CHECK(P(kNew, kNew) == Approx(0.03 * 0.03));
  CHECK(P.row(kNew).cwiseAbs().sum() == P(kNew, kNew));
  CHECK(P.topLeftCorner(kNew, kNew) == Q.topLeftCorner(kNew, kNew));
  CHECK(P.bottomLeftCorner(3, kNew) == Q.bottomLeftCorner(3, kNew));
  CHECK(P.bottomRightCorner(3, 3) == Q.bottomRightCorner(3, 3));
  CHECK(estimate.state().ambiguities[2].value_m == before.state().ambiguities[2].value_m);
  CHECK_FALSE(estimate.process().continuous);
  estimate.add_vehicle_constants(kOdometerScale);  // it is there already
  CHECK(P.rows() == Q.rows() + 1);
}

}  // namespace
}  // namespace leonav
