// Position, velocity and clocks from one epoch alone: weighted least squares with fault exclusion.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/gnss/band_bias.h"
#include "core/gnss/gnss_config.h"
#include "core/gnss/igg3.h"
#include "core/gnss/measurement.h"
#include "core/gnss/observation.h"

namespace leonav {

enum class PointStatus : std::uint8_t {
  kOk = 0,
  kTooFewSatellites,
  kSingularGeometry,
  kNotConverged,
  kFaulty,  // residuals too large for any subset of satellites
};

struct PointSolution {
  PointStatus status = PointStatus::kTooFewSatellites;
  bool has_velocity = false;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_p_e = Eigen::Matrix3d::Zero();  // m^2
  Eigen::Matrix3d covariance_v_e = Eigen::Matrix3d::Zero();  // (m/s)^2
  std::array<double, kMaxTimeBases> clock_m{};               // per System; NaN where not observed
  std::array<double, kMaxTimeBases> clock_drift_m_s{};       // likewise
  int satellites = 0;                                        // with code used
  double pdop = 0.0;
  double residual_rms_m = 0.0;
};

// Solves `raw` from scratch (an approximate position of zero is fine) and leaves in `epoch` the
// preprocessed measurements at the solution with a reason for each. `biases` as for preprocess().
// Caps on satellites do not hold: who experiments with few wants to start all the same.
PointSolution solve_point(const RawEpoch& raw, const SatelliteCatalog& catalog,
                          const GnssConfig& config, const RobustConfig& robust,
                          const Eigen::Vector3d& approximate_p_e, MeasurementEpoch* epoch,
                          BandBiases* biases = nullptr);

}  // namespace leonav
