// This unit solves position, velocity and clocks from one epoch alone, by weighted least squares
// with fault exclusion.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/preprocessing/receiver_code_bias.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/gnss/signals/observation.h"
#include "core/robust/igg3.h"

namespace leonav {

// Outcome of a point solution; only kOk gives a usable position.
enum class PointStatus : std::uint8_t {
  kOk = 0,
  kTooFewSatellites,
  kSingularGeometry,
  kNotConverged,
  kFaulty,  // residuals too large for any subset of satellites
};

// Position and velocity (ECEF, m and m/s) with clocks and quality.
struct PointSolution {
  PointStatus status = PointStatus::kTooFewSatellites;
  bool has_velocity = false;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_p_e = Eigen::Matrix3d::Zero();  // m^2
  Eigen::Matrix3d covariance_v_e = Eigen::Matrix3d::Zero();  // (m/s)^2
  std::array<double, kMaxSystemTimes> clock_m{};             // per System; NaN where not observed
  std::array<double, kMaxSystemTimes> clock_drift_m_s{};     // per System; NaN where not observed
  int satellites = 0;                                        // satellites whose code is used
  double pdop = 0.0;
  double residual_rms_m = 0.0;
};

// Returns the number of satellites beyond those that the position and one clock per system time
// need.
int redundancy(const PointSolution& point);

// Solves `raw` from scratch (an approximate position of zero is valid) and leaves in `epoch` the
// preprocessed measurements at the solution with a reason for each. `biases` are those of
// preprocess() and should go with the same `signal_biases` as there, `faulty` satellites are not
// used. SystemConfig::max_satellites does not apply, so
// that an experiment with few satellites can start.
PointSolution solve_point(const RawEpoch& raw, const EphemerisStore& ephemeris_store,
                          const GnssConfig& config, const RobustConfig& robust,
                          const Eigen::Vector3d& approximate_p_e, MeasurementEpoch* epoch,
                          ReceiverCodeBiases* biases = nullptr,
                          std::span<const SatelliteId> faulty = {},
                          const SignalBiasStore* signal_biases = nullptr);

}  // namespace leonav
