// This unit measures how well the gyros alone, with an ideal alignment, follow the course. The
// result bounds the accuracy of a heading from these gyros.
#pragma once
#include <span>
#include <string>

#include "core/inertial/strapdown/imu.h"
#include "tools/evaluate/errors.h"
#include "tools/evaluate/statistics.h"

namespace leonav {

// Heading from the gyros minus course, rad.
struct GyroHeading {
  Distribution at_once;  // at the same instant
  Distribution steady;   // only where the course is steady (ErrorOptions), with a separate fit
  Distribution at_best_delay;  // heading that much later, with a separate fit
  double best_delay_s = 0.0;
  double drift_rad_s = 0.0;  // fitted with the offset, at no delay
};

// Integrates the rate about the vertical (the low-passed specific force) and fits it to the course.
//
// Offset and linear drift are fitted by least squares, for each row over its own epochs only: no
// heading that follows the gyros with a constant drift can have a smaller RMSE. A filter has to
// estimate both, and may have a smaller RMSE only by following changes of the drift. The remainder
// is motion in which heading and course differ, gyro scale, and the truth's own noise. Throws
// std::runtime_error if IMU and courses have no common time.
GyroHeading evaluate_gyro_heading(std::span<const ImuSample> imu, const Track& truth,
                                  const ErrorOptions& options);

// Formats the result as a table.
std::string to_table(const GyroHeading& gyro);

}  // namespace leonav
