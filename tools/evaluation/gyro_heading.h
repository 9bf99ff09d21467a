// How well the gyros alone, told the truth, follow the course: a measure of what can be reached.
#pragma once
#include <span>
#include <string>

#include "core/ins/imu.h"
#include "tools/evaluation/errors.h"
#include "tools/evaluation/statistics.h"

namespace leonav {

struct GyroHeading {
  Distribution at_once;        // rad: heading minus course at the same instant
  Distribution steady;         // where the course is steady (ErrorOptions), with its own fit
  Distribution at_best_delay;  // heading that much later, with its own fit
  double best_delay_s = 0.0;
  double drift_rad_s = 0.0;  // fitted with the offset, at no delay
};

// The rate about the vertical (the specific force, low-passed) is summed up; an offset and a linear
// drift are fitted to the truth's course by least squares, for each row over just its own epochs:
// no heading that follows the gyros with a constant drift can have a smaller RMSE there. A filter
// has to find both itself; it may beat this only by following changes of the drift. What is left is
// motion in which heading and course truly differ, gyro scale and the truth's own noise. Throws
// std::runtime_error where IMU and courses have no common time.
GyroHeading judge_gyro_heading(std::span<const ImuSample> imu, const Track& truth,
                               const ErrorOptions& options);

std::string to_table(const GyroHeading& gyro);

}  // namespace leonav
