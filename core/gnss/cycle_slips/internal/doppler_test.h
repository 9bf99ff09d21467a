// This unit tests the change of the carrier between two epochs against the mean of the Dopplers at
// both.
#pragma once
#include <array>
#include <cmath>
#include <span>

#include "core/gnss/measurement/cycle_slip_config.h"

namespace leonav {

// Changes and rates of one satellite between two epochs.
struct DopplerRow {
  // Values are per signal; NaN: none.
  std::array<double, 2> carrier_change_m = {NAN, NAN};
  std::array<double, 2> mean_rate_m_s = {NAN, NAN};  // positive: range grows
  std::array<double, 2> wavelength_m = {0.0, 0.0};
  double elevation = 0.0;      // rad
  bool exceeds_limit = false;  // result: a signal's carrier did not follow its Doppler
};

// Sets exceeds_limit of each row. The part that all satellites share (a clock that jumps in the
// carrier) is removed as the median of at least four. The satellites' scatter raises the limit
// where a manoeuvre's jerk or the receiver makes it larger than the model's.
void test_doppler(const CycleSlipConfig& config, double interval_s, std::span<DopplerRow> rows);

}  // namespace leonav
