// The numbers an evaluation prints.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/evaluation/errors.h"

namespace leonav {

// Of a list of errors: signed values keep their mean; percentiles are of the absolute values.
struct Distribution {
  std::size_t count = 0;
  double mean = 0.0, rmse = 0.0, p50 = 0.0, p95 = 0.0, p99 = 0.0, worst = 0.0;
};
Distribution distribution_of(const std::vector<double>& values);

// Smallest value that at least `share` (0 to 1) of the absolute values do not exceed.
double percentile(std::vector<double> values, double share);

struct Evaluation {
  std::string label;
  SkippedRows skipped;  // of the solution's file
  Comparison comparison;
  Distribution north, east, up, horizontal, three_d;  // m
  std::optional<Distribution> speed;                  // m/s, 3D
  std::optional<Distribution> roll, pitch, yaw;       // rad
  bool yaw_from_course = false;
  std::optional<Distribution> yaw_steady;  // rad, of yaw: where the course is steady
  double availability = 0.0;               // answered epochs over expected epochs
  std::optional<double> convergence_s;     // since the first answer; absent: never
  std::optional<double> settled_s;  // likewise; from here on always below; absent: not at the end
  double convergence_bound_m = 3.0;
  std::optional<double> within_three_sigma;  // share of N, E, U errors within 3 stated sigma
};

// Throws std::runtime_error where solution and truth have no common time.
Evaluation evaluate(const std::string& label, const Track& solution, const Track& truth,
                    const ErrorOptions& options, double convergence_bound_m);

// Time from the first sample until the first of ten consecutive epochs whose 3D error is below
// `bound_m` (the papers' rule). nullopt: never.
std::optional<double> convergence_time_s(const std::vector<ErrorSample>& errors, double bound_m);

// Time from the first sample until the 3D error stays below `bound_m` to the end. nullopt: the last
// one is not.
std::optional<double> settling_time_s(const std::vector<ErrorSample>& errors, double bound_m);

// A table for people, one row per component, one block per run; and the same as JSON.
std::string to_table(const std::vector<Evaluation>& evaluations);
std::string to_json(const std::vector<Evaluation>& evaluations);

}  // namespace leonav
