// What a contradicted prediction may change, and what not.
#include "core/filter/innovation_tests/prediction_consistency.h"

#include "support/catch.h"
#include "synthetic.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Vector3d;

TEST_CASE("a point that is told not to move does not, whatever the Dopplers agree on") {
  synthetic::Generator noise(3);
  synthetic::Truth truth;
  truth.p_antenna_e = synthetic::start_position();
  truth.clocks.offset_m.setConstant(1000.0);
  truth.clocks.drift_m_s.setZero();
  EkfConfig config;
  config.static_point = true;
  Ekf filter(config, ImuErrorModel(), Vector3d::Zero());
  filter.initialize(synthetic::kStart, synthetic::point_near(truth, 3.0, 0.1, &noise));
  for (int k = 1; k <= 20; ++k) {
    truth.v_antenna_e = k > 10 ? Vector3d(8.0, -3.0, 5.0) : Vector3d::Zero().eval();
    const GpsTime time = synthetic::kStart.plus_seconds(k);
    filter.predict({}, time);
    const MeasurementEpoch epoch =
        synthetic::measure(time, synthetic::eight_satellites(), truth, 0.5, 0.05, &noise);
    filter.update(epoch);
  }
  CHECK(filter.state().v_e == Vector3d::Zero());
  CHECK(filter.covariance().block<3, 3>(kVelocity, kVelocity).isZero(0.0));
  CHECK((filter.state().p_e - truth.p_antenna_e).norm() < 2.0);
}

}  // namespace leonav
