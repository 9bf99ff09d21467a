// Change of the carrier between two epochs against the mean of the Dopplers at both.
#pragma once
#include <array>
#include <cmath>
#include <span>

#include "core/gnss/cycle_slip_config.h"

namespace leonav {

struct DopplerRow {
  // Per signal; NaN: none.
  std::array<double, 2> carrier_change_m = {NAN, NAN};
  std::array<double, 2> mean_rate_m_s = {NAN, NAN};  // positive: range grows
  std::array<double, 2> wavelength_m = {0.0, 0.0};
  double elevation = 0.0;  // rad
  bool loud = false;       // out: a signal's carrier did not follow its Doppler
};

// What all satellites share (a clock that jumps in the carrier) is taken out as the median of at
// least four; what they scatter by, where a manoeuvre's jerk or the receiver makes it more than the
// model's, widens the limit.
void check_doppler(const CycleSlipConfig& config, double interval_s, std::span<DopplerRow> rows);

}  // namespace leonav
