// This unit prints an evaluation: a table for people, JSON for programs.
#include <array>
#include <cmath>
#include <utility>

#include "core/base/angle.h"
#include "tools/common/format.h"
#include "tools/evaluate/internal/gyro_heading.h"
#include "tools/evaluate/statistics.h"

namespace leonav {
namespace {

using Row = std::pair<const char*, Distribution>;

Distribution scaled(Distribution d, double factor) {
  for (double* value : {&d.mean, &d.rmse, &d.p50, &d.p95, &d.p99, &d.worst}) *value *= factor;
  return d;
}

std::vector<Row> rows_of(const Evaluation& e) {
  std::vector<Row> rows = {{"north_m", e.north},
                           {"east_m", e.east},
                           {"up_m", e.up},
                           {"horizontal_m", e.horizontal},
                           {"3d_m", e.three_d}};
  if (e.speed) rows.emplace_back("velocity_m_s", *e.speed);
  if (e.roll) rows.emplace_back("roll_deg", scaled(*e.roll, kDegreesPerRadian));
  if (e.pitch) rows.emplace_back("pitch_deg", scaled(*e.pitch, kDegreesPerRadian));
  if (e.yaw) {
    rows.emplace_back(e.yaw_from_course ? "yaw_minus_course_deg" : "yaw_deg",
                      scaled(*e.yaw, kDegreesPerRadian));
  }
  if (e.yaw_steady) {
    rows.emplace_back("yaw_steady_course_deg", scaled(*e.yaw_steady, kDegreesPerRadian));
  }
  return rows;
}

std::string cdf_json(const std::vector<ErrorSample>& errors, double (ErrorSample::*get)() const) {
  std::vector<double> values;
  for (const ErrorSample& sample : errors) values.push_back((sample.*get)());
  std::string out = "[";
  for (int percent = 5; percent <= 100; percent += 5) {
    out += format("%s[%d, %.4f]", percent == 5 ? "" : ", ", percent,
                  percentile(values, percent / 100.0));
  }
  return out + "]";
}

}  // namespace

std::string to_table(const std::vector<Evaluation>& evaluations) {
  std::string out;
  for (const Evaluation& e : evaluations) {
    const Comparison& c = e.comparison;
    out += format(
        "%s: %zu epochs compared of %zu answered; availability %.2f %% of %zu from first to last",
        e.label.c_str(), c.errors.size(), c.solution_epochs, 100.0 * e.availability,
        c.expected_epochs);
    out += format(" answer, of the %zu in the truth's span %.2f %%\n", c.expected_in_truth,
                  c.expected_in_truth == 0 ? 0.0
                                           : 100.0 * static_cast<double>(c.solution_epochs) /
                                                 static_cast<double>(c.expected_in_truth));
    if (e.skipped.skipped > 0) {
      out += "  " + to_string(e.skipped) +
             "  the availability counts only the rows that could be read\n";
    }
    out +=
        format("  %-21s%9s%9s%9s%9s%9s%9s\n", "", "rmse", "mean", "50 %", "95 %", "99 %", "worst");
    for (const auto& [name, d] : rows_of(e)) {
      out += format("  %-21s%9.3f%9.3f%9.3f%9.3f%9.3f%9.3f\n", name, d.rmse, d.mean, d.p50, d.p95,
                    d.p99, d.worst);
    }
    if (e.yaw_steady) {
      out += format("  the course is steady in %zu of the %zu epochs with a course\n",
                    e.yaw_steady->count, e.yaw->count);
    }
    out += e.convergence_s
               ? format("  converged below %.2f m (3D, ten epochs in a row) after %.1f s\n",
                        e.convergence_bound_m, *e.convergence_s)
               : format("  did not converge below %.2f m (3D, ten epochs in a row)\n",
                        e.convergence_bound_m);
    if (e.settled_s) {
      out +=
          format("  below %.2f m (3D) for good after %.1f s; at the end N %.3f E %.3f U %.3f m\n",
                 e.convergence_bound_m, *e.settled_s, c.errors.back().neu.x(),
                 c.errors.back().neu.y(), c.errors.back().neu.z());
    }
    if (e.within_three_sigma) {
      out += format("  within three stated sigma: %.2f %%\n", 100.0 * *e.within_three_sigma);
    }
    if (c.removed_offset_neu.norm() > 0.0) {
      out += format("  constant offset removed: N %.3f E %.3f U %.3f m\n", c.removed_offset_neu.x(),
                    c.removed_offset_neu.y(), c.removed_offset_neu.z());
    }
  }
  return out;
}

std::string to_table(const GyroHeading& gyro) {
  std::string out = "gyros alone, heading minus course (offset and drift fitted to the truth):\n";
  out +=
      format("  %-21s%9s%9s%9s%9s%9s%9s\n", "", "count", "rmse", "mean", "50 %", "95 %", "worst");
  auto row = [&](const char* name, const Distribution& radians) {
    const Distribution d = scaled(radians, kDegreesPerRadian);
    out += format("  %-21s%9zu%9.3f%9.3f%9.3f%9.3f%9.3f\n", name, d.count, d.rmse, d.mean, d.p50,
                  d.p95, d.worst);
  };
  row("at_once_deg", gyro.at_once);
  if (gyro.steady.count > 0) row("steady_course_deg", gyro.steady);
  row("at_best_delay_deg", gyro.at_best_delay);
  out += format("  best delay of the heading after the course %.2f s, drift %.3f deg/s\n",
                gyro.best_delay_s, gyro.drift_rad_s * kDegreesPerRadian);
  return out;
}

std::string to_json(const std::vector<Evaluation>& evaluations) {
  std::string out = "[\n";
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    const Evaluation& e = evaluations[i];
    const Comparison& c = e.comparison;
    out +=
        format(" {\"label\": %s, \"epochs\": %zu, \"answered\": %zu, \"expected\": %zu,",
               json_string(e.label).c_str(), c.errors.size(), c.solution_epochs, c.expected_epochs);
    out += format(" \"expected_in_truth\": %zu,", c.expected_in_truth);
    out += format(" \"skipped_rows\": %ld,", e.skipped.skipped);
    out += format(" \"availability\": %.6f, \"interval_s\": %.4f,\n", e.availability, c.interval_s);
    out += format("  \"convergence_bound_m\": %.3f, \"convergence_s\": ", e.convergence_bound_m);
    out += e.convergence_s ? format("%.3f", *e.convergence_s) : "null";
    out += ", \"settled_s\": ";
    out += e.settled_s ? format("%.3f", *e.settled_s) : "null";
    out += ", \"within_three_sigma\": ";
    out += e.within_three_sigma ? format("%.6f", *e.within_three_sigma) : "null";
    out += format(",\n  \"removed_offset_neu_m\": [%.4f, %.4f, %.4f]", c.removed_offset_neu.x(),
                  c.removed_offset_neu.y(), c.removed_offset_neu.z());
    for (const auto& [name, d] : rows_of(e)) {
      out += format(",\n  \"%s\": {\"count\": %zu, \"rmse\": %.5f, \"mean\": %.5f, \"p50\": %.5f, ",
                    name, d.count, d.rmse, d.mean, d.p50);
      out += format("\"p95\": %.5f, \"p99\": %.5f, \"worst\": %.5f}", d.p95, d.p99, d.worst);
    }
    out += ",\n  \"cdf_horizontal_percent_m\": " + cdf_json(c.errors, &ErrorSample::horizontal);
    out += ",\n  \"cdf_3d_percent_m\": " + cdf_json(c.errors, &ErrorSample::three_d) + "}";
    out += i + 1 < evaluations.size() ? ",\n" : "\n";
  }
  return out + "]\n";
}

}  // namespace leonav
