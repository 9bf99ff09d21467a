// This is the two-state model of the receiver clock: an offset (m) and a drift (m/s) per satellite
// system, all driven by one oscillator (Brown and Hwang 2012, 9.3).
#pragma once
#include <cstddef>

#include "core/filter/state/ekf_config.h"
#include "core/filter/state/ekf_state.h"

namespace leonav {

// 1 sigma of a drift that nothing has measured, m/s: an oscillator off by 1 ppm.
inline constexpr double kUnknownDriftSigma = 300.0;

// Propagates the covariance of the systems observed so far by `dt` seconds; the caller moves the
// offsets by their drifts. The oscillator's noise is common to all systems (fully correlated), and
// each system has its own noise against it.
void propagate_clocks(const ClockModel& model, const ClockFlags& known, double dt,
                      EkfCovariance* covariance);

// Starts the offset of system `system`, uncorrelated with all other states.
void start_clock_offset(std::size_t system, double offset_m, double sigma_m, ClockState* clocks,
                        EkfCovariance* covariance);

// Starts the drift of system `system`, uncorrelated with all other states.
void start_clock_drift(std::size_t system, double drift_m_s, double sigma_m_s, ClockState* clocks,
                       EkfCovariance* covariance);

// Starts the drift of system `to` as that of system `from`, with `sigma_m_s` between them.
void copy_clock_drift(std::size_t from, std::size_t to, double sigma_m_s, ClockState* clocks,
                      EkfCovariance* covariance);

}  // namespace leonav
