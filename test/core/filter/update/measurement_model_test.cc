#include "core/filter/update/measurement_model.h"

#include <cmath>

#include "core/filter/state/filter_state.h"
#include "support/catch.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;

struct Situation {
  NavState state;
  ClockState clocks;
  double wet_delay_m = 0.0;
  double carrier_clock_m = 0.0;
  double ionosphere_m = 0.0;
  Vector3d rate_b{0.3, -0.2, 0.8};
  Vector3d lever_b{1.2, -0.4, -1.1};
};

Situation situation() {
  Situation s;
  s.state.p_e = synthetic::start_position();
  const Eigen::Matrix3d C_en = synthetic::C_en_at(s.state.p_e);
  s.state.q_eb = Eigen::Quaterniond(C_en * rotation_from_euler({0.1, -0.2, 2.1}));
  s.state.v_e = C_en * Vector3d{9.0, -14.0, 0.5};
  s.state.errors.gyro_bias_b << 0.01, -0.02, 0.03;
  s.state.errors.gyro_scale << 0.02, 0.01, -0.03;
  s.wet_delay_m = 0.1;
  s.clocks.offset_m << 1e3, 2e3, 3e3, 4e3;
  s.clocks.drift_m_s << 10.0, 11.0, 12.0, 13.0;
  return s;
}

Situation perturbed(Situation s, int index, double step) {
  const int axis = index % 3;
  if (index == kIonosphere) {
    s.ionosphere_m += step;
  } else if (index == kCarrierClock) {
    s.carrier_clock_m += step;
  } else if (index == kWetDelay) {
    s.wet_delay_m += step;
  } else if (index >= kClockDrift) {
    s.clocks.drift_m_s(index - kClockDrift) += step;
  } else if (index >= kClock) {
    s.clocks.offset_m(index - kClock) += step;
  } else if (index >= kAccelScale) {
    s.state.errors.accel_scale(axis) += step;
  } else if (index >= kGyroScale) {
    s.state.errors.gyro_scale(axis) += step;
  } else if (index >= kAccelBias) {
    s.state.errors.accel_bias_b(axis) += step;
  } else if (index >= kGyroBias) {
    s.state.errors.gyro_bias_b(axis) += step;
  } else if (index >= kAttitude) {
    s.state.q_eb = quaternion_from_rotation_vector(step * Vector3d::Unit(axis)) * s.state.q_eb;
  } else if (index >= kVelocity) {
    s.state.v_e(axis) += step;
  } else {
    s.state.p_e(axis) += step;
  }
  return s;
}

double predicted(const Situation& s, const Measurement& measurement, const SatelliteInView& view,
                 bool has_attitude) {
  return predict_measurement(measurement, view,
                             antenna_motion(s.state, s.rate_b, s.lever_b, has_attitude), s.clocks,
                             s.wet_delay_m, s.carrier_clock_m, s.ionosphere_m)
      .value;
}

}  // namespace

TEST_CASE("every column of the measurement Jacobian is the numerical derivative") {
  const Situation s = situation();
  SatelliteInView leo = synthetic::satellite_at(System::kLeo, 120, 1.0, 0.7);
  leo.p_e = s.state.p_e + 1.2e6 * (leo.p_e - s.state.p_e).normalized();
  leo.v_e *= 7500.0 / leo.v_e.norm();
  leo.wet_mapping = 1.6;
  SatelliteInView gps = synthetic::satellite_at(System::kGps, 3, 4.0, 0.4);
  gps.wet_mapping = 2.4;
  for (const SatelliteInView& view : {gps, leo}) {
    for (const Observable observable :
         {Observable::kCode, Observable::kCarrier, Observable::kDoppler}) {
      Measurement measurement;
      measurement.observable = observable;
      if (observable == Observable::kCode) measurement.ionosphere.mapping = 2.7;
      for (const bool has_attitude : {true, false}) {
        const EkfVector row =
            predict_measurement(measurement, view,
                                antenna_motion(s.state, s.rate_b, s.lever_b, has_attitude),
                                s.clocks, s.wet_delay_m, s.carrier_clock_m, s.ionosphere_m)
                .row;
        for (int column = 0; column < kSize; ++column) {
          // Positions need room: a range of 2e7 m has a resolution of 4e-9 m.
          const double step = column < kVelocity                       ? 20.0
                              : column >= kClock || column < kAttitude ? 1.0
                              : column < kGyroBias                     ? 1e-3
                                                                       : 1e-2;
          const double numeric =
              (predicted(perturbed(s, column, step), measurement, view, has_attitude) -
               predicted(perturbed(s, column, -step), measurement, view, has_attitude)) /
              (2.0 * step);
          INFO("column " << column << " observable " << static_cast<int>(observable) << " attitude "
                         << has_attitude);
          CHECK(row(column) == Approx(numeric).epsilon(2e-4).margin(2e-6));
        }
      }
    }
  }
}

TEST_CASE("lever arm and time offset: every column is the numerical derivative") {
  const Situation s = situation();
  const Vector3d acceleration_e = synthetic::C_en_at(s.state.p_e) * Vector3d{1.5, -2.0, 0.3};
  FilterState whole;
  whole.nav = s.state;
  whole.vehicle = {0.0, 0.0, 0.0, 0.3, -0.4, 0.5, 0.04};
  SatelliteInView leo = synthetic::satellite_at(System::kLeo, 120, 1.0, 0.7);
  leo.p_e = s.state.p_e + 1.2e6 * (leo.p_e - s.state.p_e).normalized();
  leo.v_e *= 7500.0 / leo.v_e.norm();
  const auto predict = [&](const FilterState& at, Observable observable) {
    Measurement measurement;
    measurement.observable = observable;
    return predict_measurement(
        measurement, leo,
        antenna_motion(at.nav, s.rate_b, s.lever_b, true, at.vehicle, acceleration_e), s.clocks,
        0.1, 0.0, 0.0);
  };
  for (const Observable observable : {Observable::kCode, Observable::kDoppler}) {
    const MeasurementPrediction here = predict(whole, observable);
    for (int state = 0; state < whole.first_ambiguity(); ++state) {
      const bool of_position = state < kVelocity;
      const bool of_attitude = state >= kAttitude && state < kGyroBias;
      const bool of_constants = state >= kSize;
      if (!of_position && !of_attitude && !of_constants && state >= kAccelBias) continue;
      const double step = of_position ? 20.0 : of_attitude || state >= kGyroBias ? 1e-3 : 1.0;
      EkfCorrection error = EkfCorrection::Zero(whole.first_ambiguity());
      error(state) = step;
      FilterState after = whole, before = whole;
      add(error, true, &after);
      add(-error, true, &before);
      const double slope =
          (predict(after, observable).value - predict(before, observable).value) / (2.0 * step);
      const int constant = state - kSize - kLeverArm;
      const double row = state < kSize  ? here.row(state)
                         : constant < 0 ? 0.0
                                        : here.constants(constant);
      INFO("state " << state << " observable " << static_cast<int>(observable));
      CHECK(row == Approx(slope).epsilon(2e-4).margin(1e-5));
    }
  }
}

TEST_CASE("an IMU that is late has the antenna where it was") {
  Situation s = situation();
  const Vector3d acceleration_e = synthetic::C_en_at(s.state.p_e) * Vector3d{1.5, -2.0, 0.3};
  constexpr double kOffset_s = 0.04;
  const VehicleConstants constants = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, kOffset_s};
  const AntennaMotion now =
      antenna_motion(s.state, s.rate_b, s.lever_b, true, constants, acceleration_e);
  // The same body 40 ms before, by its equations of motion.
  const Vector3d omega_b = (s.rate_b - s.state.errors.gyro_bias_b)
                               .cwiseQuotient(Vector3d::Ones() + s.state.errors.gyro_scale);
  NavState before = s.state;
  before.p_e += -kOffset_s * s.state.v_e + 0.5 * kOffset_s * kOffset_s * acceleration_e;
  before.v_e -= kOffset_s * acceleration_e;
  const Vector3d omega_ie{0.0, 0.0, kEarthRotationRate};
  before.q_eb = quaternion_from_rotation_vector(kOffset_s * omega_ie) * s.state.q_eb *
                quaternion_from_rotation_vector(-kOffset_s * omega_b);
  const AntennaMotion then = antenna_motion(before, s.rate_b, s.lever_b, true);
  // What is left out is the antenna's acceleration about the IMU: half of w^2 l dt^2, and w^2 l dt.
  const double about = omega_b.squaredNorm() * s.lever_b.norm();
  CHECK((now.p_e - then.p_e).norm() < 0.5 * kOffset_s * kOffset_s * about);
  CHECK((now.v_e - then.v_e).norm() < kOffset_s * about);
}

TEST_CASE("the antenna's velocity is the derivative of its position") {
  const Situation s = situation();
  // The body turns at the true rate against i; over dt its attitude against e changes by that
  // less the Earth's rotation.
  const Vector3d omega_b = (s.rate_b - s.state.errors.gyro_bias_b)
                               .cwiseQuotient(Vector3d::Ones() + s.state.errors.gyro_scale);
  const auto at = [&](double t) {
    NavState moved = s.state;
    moved.p_e += t * s.state.v_e;
    const Vector3d omega_ie{0.0, 0.0, kEarthRotationRate};
    moved.q_eb = quaternion_from_rotation_vector(-t * omega_ie) * s.state.q_eb *
                 quaternion_from_rotation_vector(t * omega_b);
    return antenna_motion(moved, s.rate_b, s.lever_b, true).p_e;
  };
  constexpr double kDt = 1e-3;
  const Vector3d numeric = (at(kDt) - at(-kDt)) / (2.0 * kDt);
  const Vector3d v = antenna_motion(s.state, s.rate_b, s.lever_b, true).v_e;
  CHECK((numeric - v).norm() < 2e-6);
}

}  // namespace leonav
