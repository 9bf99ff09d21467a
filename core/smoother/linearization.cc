#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Index;

double weight_of(const KeyframeMeasurement& measurement) {
  return measurement.factor / measurement.gain_variance;
}

}  // namespace

double row_of(const LinearMeasurement& linear, int state) {
  if (state < kSize) return linear.row(state);
  return state < kSize + kLeverArm ? 0.0 : linear.constants(state - kSize - kLeverArm);
}

AntennaMotion antenna_of(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b) {
  return antenna_of(keyframe, keyframe.state, lever_arm_b);
}

AntennaMotion antenna_of(const Keyframe& keyframe, const FilterState& state,
                         const Eigen::Vector3d& lever_arm_b) {
  AntennaMotion antenna =
      antenna_motion(state.nav, keyframe.measured_rate_b, lever_arm_b, keyframe.has_attitude,
                     state.vehicle, keyframe.acceleration_e);
  antenna.p_e += keyframe.vertical_antenna_offset_e;
  return antenna;
}

LinearMeasurement linearize(const MeasuredObservable& measurement,
                            const SatelliteGeometry& satellite, const CoreState& state,
                            const AntennaMotion& antenna) {
  const MeasurementPrediction prediction =
      predict_measurement(measurement, satellite, antenna, state.clocks, state.wet_delay_m,
                          state.carrier_clock_m, state.ionosphere_m);
  LinearMeasurement linear;
  linear.residual = measurement.value - prediction.value;
  linear.row = prediction.row;
  linear.constants = prediction.constants;
  return linear;
}

LinearMeasurement linearize(const KeyframeMeasurement& measurement, const Keyframe& keyframe,
                            const AntennaMotion& antenna) {
  return linearize(measurement, keyframe, keyframe.state, antenna);
}

LinearMeasurement linearize(const KeyframeMeasurement& measurement, const Keyframe& keyframe,
                            const FilterState& state, const AntennaMotion& antenna) {
  LinearMeasurement linear =
      linearize(measurement.measurement,
                keyframe.satellites[measurement.measurement.satellite_index], state, antenna);
  if (measurement.ambiguity >= 0)
    linear.residual -= state.ambiguities[static_cast<std::size_t>(measurement.ambiguity)].value_m;
  return linear;
}

void accumulate_information(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b,
                            MeasurementInformation* sum) {
  const ActiveStates& active = keyframe.active;
  const Index core = active.core_size();
  sum->information.setZero(active.size(), active.size());
  sum->gradient.setZero(active.size());
  const AntennaMotion antenna = antenna_of(keyframe, lever_arm_b);
  BoundedVector<kSize + kMaxVehicle> row(core);
  for (const KeyframeMeasurement& measurement : keyframe.measurements) {
    const double weight = weight_of(measurement);
    if (!(weight > 0.0)) continue;
    const LinearMeasurement linear = linearize(measurement, keyframe, antenna);
    for (Index i = 0; i < core; ++i)
      row(i) = row_of(linear, active.core[static_cast<std::size_t>(i)]);
    for (Index j = 0; j < core; ++j) {
      if (row(j) == 0.0) continue;
      sum->information.col(j).head(core) += (weight * row(j)) * row;
    }
    sum->gradient.head(core) += weight * linear.residual * row;
    if (measurement.ambiguity < 0) continue;
    const Index ambiguity = core + measurement.ambiguity;
    sum->information.row(ambiguity).head(core) += weight * row.transpose();
    sum->information.col(ambiguity).head(core) += weight * row;
    sum->information(ambiguity, ambiguity) += weight;
    sum->gradient(ambiguity) += weight * linear.residual;
  }
}

}  // namespace leonav
