#include "core/smoother/linearization.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/median.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Index;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr std::size_t kKinds = 3;          // observables
constexpr double kNormalMedian = 0.6745;   // median of |x| for a standard normal x
constexpr std::size_t kMinScaleCount = 5;  // fewer residuals do not tell their scale
constexpr double kMaxCarrierScale = 2.0;   // carriers that fit no better have slipped
constexpr double kMaxScale = 3.0;

double weight_of(const KeyframeMeasurement& measurement) {
  return measurement.factor / measurement.gain_variance;
}

// Where half of an observable's residuals are larger than they should be, all are scaled down, so
// that the many are not thrown out for the few.
std::array<double, kKinds> scales(const KeyframeMeasurements& measurements,
                                  const SmallTable& ratios) {
  std::array<double, kKinds> scale = {1.0, 1.0, 1.0};
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    SmallTable of_kind;
    for (std::size_t i = 0; i < measurements.size(); ++i)
      if (measurements[i].measurement.observable == static_cast<Observable>(kind))
        of_kind.push_back(ratios[i]);
    if (of_kind.size() < kMinScaleCount) continue;
    const bool carrier = static_cast<Observable>(kind) == Observable::kCarrier;
    scale[kind] =
        std::clamp(median(of_kind) / kNormalMedian, 1.0, carrier ? kMaxCarrierScale : kMaxScale);
  }
  return scale;
}

}  // namespace

AntennaMotion antenna_of(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b) {
  AntennaMotion antenna = antenna_motion(keyframe.state.nav, keyframe.measured_rate_b, lever_arm_b,
                                         keyframe.has_attitude);
  antenna.p_e += keyframe.mast_e;
  return antenna;
}

LinearMeasurement linearize(const KeyframeMeasurement& measurement, const Keyframe& keyframe,
                            const AntennaMotion& antenna) {
  const FilterState& state = keyframe.state;
  const SatelliteInView& satellite = keyframe.satellites[measurement.measurement.satellite_index];
  const MeasurementPrediction prediction =
      predict_measurement(measurement.measurement, satellite, antenna, state.clocks,
                          state.wet_delay_m, state.carrier_clock_m);
  LinearMeasurement linear;
  linear.residual = measurement.measurement.value - prediction.value;
  if (measurement.ambiguity >= 0)
    linear.residual -= state.ambiguities[static_cast<std::size_t>(measurement.ambiguity)].value_m;
  linear.row = prediction.row;
  return linear;
}

void gather_information(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b,
                        MeasurementInformation* sum) {
  const ActiveStates& active = keyframe.active;
  const Index core = active.core_size();
  sum->information.setZero(active.size(), active.size());
  sum->gradient.setZero(active.size());
  const AntennaMotion antenna = antenna_of(keyframe, lever_arm_b);
  BoundedVector<kSize> row(core);
  for (const KeyframeMeasurement& measurement : keyframe.measurements) {
    const double weight = weight_of(measurement);
    if (!(weight > 0.0)) continue;
    const LinearMeasurement linear = linearize(measurement, keyframe, antenna);
    for (Index i = 0; i < core; ++i) row(i) = linear.row(active.core[static_cast<std::size_t>(i)]);
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

double reweigh(const RobustConfig& config, const Eigen::Vector3d& lever_arm_b, Keyframe* keyframe) {
  KeyframeMeasurements& measurements = keyframe->measurements;
  const AntennaMotion antenna = antenna_of(*keyframe, lever_arm_b);
  SmallTable ratios;
  for (const KeyframeMeasurement& measurement : measurements) {
    const double residual = linearize(measurement, *keyframe, antenna).residual;
    // Against the others: without what the measurement itself has drawn the estimate by.
    const double drawn = 1.0 + weight_of(measurement) * measurement.others_variance;
    const double sigma = std::sqrt(measurement.variance + measurement.others_variance);
    ratios.push_back(std::abs(residual) * drawn / sigma);
  }
  const std::array<double, kKinds> scale = scales(measurements, ratios);
  double change = 0.0;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    KeyframeMeasurement& measurement = measurements[i];
    const auto kind = static_cast<std::size_t>(measurement.measurement.observable);
    const double factor = igg3_factor(ratios[i] / scale[kind], config.k0, config.k1);
    change = std::max(change, std::abs(factor - measurement.factor));
    measurement.factor = factor;
  }
  keyframe->judged = true;
  return change;
}

}  // namespace leonav
