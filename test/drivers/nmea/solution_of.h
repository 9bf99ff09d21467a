// Solutions for the tests of sentences.
#pragma once

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "core/navigator/interface/solution.h"

namespace leonav::test {

// 48 deg 7.038 min north, 11 deg 31 min east, at 12:35:19 UTC of 2020-06-25 (18 leap seconds).
inline Solution munich() {
  Solution solution;
  solution.time = from_calendar({2020, 6, 25, 12, 35, 19.0 + 18.0});
  solution.source = Source::kEkf;
  solution.has_attitude = true;
  solution.latitude = (48.0 + 7.038 / 60.0) * kDegree;
  solution.longitude = (11.0 + 31.0 / 60.0) * kDegree;
  solution.height = 545.4;
  solution.v_n = {0.0, 1852.0 / 360.0, 0.0};  // ten knots to the east
  solution.yaw = -90.0 * kDegree;
  solution.sigma_p_n = {0.5, 0.25, 1.0};
  solution.sigma_v_n = {0.02, 0.02, 0.03};
  return solution;
}

}  // namespace leonav::test
