// This unit computes the statistics that an evaluation prints.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/evaluate/errors.h"

namespace leonav {

// Statistics of a list of errors: the mean is of the signed values, percentiles are of the absolute
// values.
struct Distribution {
  std::size_t count = 0;
  double mean = 0.0, rmse = 0.0, p50 = 0.0, p95 = 0.0, p99 = 0.0, worst = 0.0;
};
// Returns the statistics of `values`.
Distribution distribution_of(const std::vector<double>& values);

// Returns the smallest value that at least `share` (0 to 1) of the absolute values do not exceed.
double percentile(std::vector<double> values, double share);

// The evaluation of one run.
struct Evaluation {
  std::string label;
  SkippedRows skipped;  // of the solution's file
  Comparison comparison;
  Distribution north, east, up, horizontal, three_d;  // m
  std::optional<Distribution> speed;                  // m/s, 3D
  std::optional<Distribution> roll, pitch, yaw;       // rad
  bool yaw_from_course = false;
  std::optional<Distribution> yaw_steady;  // rad, where the course is steady
  double availability = 0.0;               // answered epochs over expected epochs
  std::optional<double> convergence_s;     // s since the first solution; absent: never
  // s since the first solution, below the bound from then on; absent: not at the end
  std::optional<double> settled_s;
  double convergence_bound_m = 3.0;
  std::optional<double> within_three_sigma;  // share of N, E, U errors within 3 stated sigma
};

// Evaluates one run. Throws std::runtime_error if solution and truth have no common time.
Evaluation evaluate(const std::string& label, const Track& solution, const Track& truth,
                    const ErrorOptions& options, double convergence_bound_m);

// Returns the time from the first sample to the first of ten consecutive epochs with a 3D error
// below `bound_m`, as in Zhang et al. (Remote Sens. 2024, 16, 1782). nullopt: never.
std::optional<double> convergence_time_s(const std::vector<ErrorSample>& errors, double bound_m);

// Returns the time from the first sample after which the 3D error stays below `bound_m` to the end.
// nullopt: the last error is not below.
std::optional<double> settling_time_s(const std::vector<ErrorSample>& errors, double bound_m);

// These format the evaluations as a table, one row per component and one block per run, and as
// JSON.
std::string to_table(const std::vector<Evaluation>& evaluations);
std::string to_json(const std::vector<Evaluation>& evaluations);

}  // namespace leonav
