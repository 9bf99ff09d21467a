#include "core/filter/update/measurement_model.h"

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/gnss/measurement/range_model.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

AntennaMotion antenna_motion(const NavState& state, const Vector3d& measured_rate_b,
                             const Vector3d& lever_arm_b, bool has_attitude) {
  AntennaMotion antenna;
  antenna.p_e = state.p_e;
  antenna.v_e = state.v_e;
  if (!has_attitude) return antenna;

  const Matrix3d C_eb = state.q_eb.toRotationMatrix();
  const Vector3d gain = (1.0 + state.errors.gyro_scale.array()).inverse();
  const Vector3d omega_ib_b = (measured_rate_b - state.errors.gyro_bias_b).cwiseProduct(gain);
  const Vector3d omega_ie{0.0, 0.0, kEarthRotationRate};
  const Vector3d lever_e = C_eb * lever_arm_b;
  const Vector3d swing_e = C_eb * omega_ib_b.cross(lever_arm_b);
  antenna.p_e += lever_e;
  antenna.v_e += swing_e - omega_ie.cross(lever_e);

  antenna.d_p_d_attitude = -skew(lever_e);
  antenna.d_v_d_attitude = -skew(swing_e) + skew(omega_ie) * skew(lever_e);
  const Matrix3d C_lever = C_eb * skew(lever_arm_b);
  antenna.d_v_d_gyro_bias = C_lever * gain.asDiagonal();
  antenna.d_v_d_gyro_scale = C_lever * omega_ib_b.cwiseProduct(gain).asDiagonal();
  return antenna;
}

Vector3d lever_arm_correction(const VehicleConstants& vehicle) {
  if (vehicle.size() <= kLeverArm) return Vector3d::Zero();
  return {vehicle[kLeverArm], vehicle[kLeverArm + 1], vehicle[kLeverArm + 2]};
}

double time_offset_of(const VehicleConstants& vehicle) {
  return vehicle.size() <= kTimeOffset ? 0.0 : vehicle[kTimeOffset];
}

AntennaMotion antenna_motion(const NavState& state, const Vector3d& measured_rate_b,
                             const Vector3d& configured_lever_arm_b, bool has_attitude,
                             const VehicleConstants& vehicle, const Vector3d& acceleration_e) {
  const bool estimated = has_attitude && vehicle.size() > kLeverArm;
  if (!estimated)
    return antenna_motion(state, measured_rate_b, configured_lever_arm_b, has_attitude);
  AntennaMotion antenna = antenna_motion(
      state, measured_rate_b, configured_lever_arm_b + lever_arm_correction(vehicle), has_attitude);
  const Matrix3d C_eb = state.q_eb.toRotationMatrix();
  const Vector3d gain = (1.0 + state.errors.gyro_scale.array()).inverse();
  const Vector3d omega_ib_b = (measured_rate_b - state.errors.gyro_bias_b).cwiseProduct(gain);
  antenna.estimated = true;
  antenna.d_p_d_constants << C_eb, -antenna.v_e;
  antenna.d_v_d_constants << C_eb * skew(omega_ib_b) -
                                 skew(Vector3d(0.0, 0.0, kEarthRotationRate)) * C_eb,
      -acceleration_e;
  const double dt = antenna.time_offset_s = time_offset_of(vehicle);
  antenna.p_e += -dt * antenna.v_e + 0.5 * dt * dt * acceleration_e;
  antenna.v_e -= dt * acceleration_e;
  return antenna;
}

namespace {

// Adds the derivatives by way of the antenna's position and velocity; `by_p` and `by_v` are those
// by the latter.
void add_by_antenna(const RowVector3d& by_p, const RowVector3d& by_v, const AntennaMotion& antenna,
                    MeasurementPrediction* prediction) {
  // A position of another time follows the velocity.
  const RowVector3d later = -antenna.time_offset_s * by_p;
  EkfVector& row = prediction->row;
  row.segment<3>(kVelocity) += later;
  row.segment<3>(kAttitude) += later * antenna.d_v_d_attitude;
  row.segment<3>(kGyroBias) += later * antenna.d_v_d_gyro_bias;
  row.segment<3>(kGyroScale) += later * antenna.d_v_d_gyro_scale;
  prediction->constants = by_p * antenna.d_p_d_constants + (by_v + later) * antenna.d_v_d_constants;
}

}  // namespace

MeasurementPrediction predict_measurement(const MeasuredObservable& measurement,
                                          const SatelliteGeometry& satellite,
                                          const AntennaMotion& antenna, const ClockState& clocks,
                                          double wet_delay_m, double carrier_clock_m,
                                          double ionosphere_m) {
  MeasurementPrediction prediction;
  EkfVector& row = prediction.row;
  const auto system_index = static_cast<Eigen::Index>(index_of(satellite.satellite.system));
  if (measurement.observable != Observable::kDoppler) {
    const RangePrediction range = predict_range(satellite, antenna.p_e);
    prediction.value = range.range_m + clocks.offset_m(system_index) +
                       satellite.wet_mapping * wet_delay_m +
                       measurement.ionosphere.mapping * ionosphere_m;
    row.segment<3>(kPosition) = range.d_range_d_p;
    row.segment<3>(kAttitude) = range.d_range_d_p * antenna.d_p_d_attitude;
    row(kClock + system_index) = 1.0;
    row(kWetDelay) = satellite.wet_mapping;
    row(kIonosphere) = measurement.ionosphere.mapping;
    if (antenna.estimated)
      add_by_antenna(range.d_range_d_p, RowVector3d::Zero(), antenna, &prediction);
    if (measurement.observable == Observable::kCarrier) {
      prediction.value += carrier_clock_m;
      row(kCarrierClock) = 1.0;
    }
  } else {
    const RangeRatePrediction rate = predict_range_rate(satellite, antenna.p_e, antenna.v_e);
    prediction.value = rate.range_rate_m_s + clocks.drift_m_s(system_index);
    row.segment<3>(kPosition) = rate.d_rate_d_p;
    row.segment<3>(kVelocity) = rate.d_rate_d_v;
    row.segment<3>(kAttitude) =
        rate.d_rate_d_p * antenna.d_p_d_attitude + rate.d_rate_d_v * antenna.d_v_d_attitude;
    row.segment<3>(kGyroBias) = rate.d_rate_d_v * antenna.d_v_d_gyro_bias;
    row.segment<3>(kGyroScale) = rate.d_rate_d_v * antenna.d_v_d_gyro_scale;
    if (antenna.estimated) add_by_antenna(rate.d_rate_d_p, rate.d_rate_d_v, antenna, &prediction);
    row(kClockDrift + system_index) = 1.0;
  }
  return prediction;
}

}  // namespace leonav
