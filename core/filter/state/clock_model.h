// Receiver clock: one offset (m) and drift (m/s) per time base, driven by one oscillator.
#pragma once
#include <cstddef>

#include "core/filter/state/ekf_config.h"
#include "core/filter/state/ekf_state.h"

namespace leonav {

// Moves the covariance of the bases observed so far by `dt` seconds (their offsets by their drifts
// is the caller's). The oscillator's noise is the same for all bases (fully correlated), the noise
// of each base against it is its own.
void propagate_clocks(const ClockModel& model, const ClockFlags& known, double dt,
                      EkfCovariance* covariance);

// Starts the offset of a base that was not observed before, uncorrelated with all else.
void start_clock_offset(std::size_t base, double offset_m, double sigma_m, ClockState* clocks,
                        EkfCovariance* covariance);

// Likewise for its drift.
void start_clock_drift(std::size_t base, double drift_m_s, double sigma_m_s, ClockState* clocks,
                       EkfCovariance* covariance);

// The drift of a base that has given no Doppler yet is that of another, with `sigma_m_s` between
// them.
void copy_clock_drift(std::size_t from, std::size_t to, double sigma_m_s, ClockState* clocks,
                      EkfCovariance* covariance);

}  // namespace leonav
