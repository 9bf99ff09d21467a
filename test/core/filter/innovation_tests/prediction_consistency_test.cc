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

TEST_CASE("a shift is one that two thirds of the codes share; half of them is none") {
  const EkfCovariance certain = EkfCovariance::Zero(kSize, kSize);
  const auto shift_of = [&](int shifted, int others) {
    FilterMeasurements codes;
    for (int i = 0; i < shifted + others; ++i) {
      FilterMeasurement code;
      code.innovation = (i < shifted ? 150.0 : 0.0) + 0.1 * (i % 3);
      code.variance = 9.0;
      codes.push_back(code);
    }
    return common_shift(codes, Observable::kCode, certain);
  };
  CHECK(shift_of(12, 0) == Approx(150.0).margin(1.0));
  CHECK(shift_of(14, 7) == Approx(150.0).margin(1.0));
  CHECK(shift_of(13, 8) == 0.0);
  CHECK(shift_of(11, 10) == 0.0);
  CHECK(shift_of(7, 14) == 0.0);
}

}  // namespace leonav
