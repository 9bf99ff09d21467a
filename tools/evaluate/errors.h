// This unit computes the errors of a solution against a truth, epoch by epoch.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "tools/evaluate/track.h"

namespace leonav {

// Settings of a comparison.
struct ErrorOptions {
  double max_truth_gap_s = 2.0;  // the truth is not interpolated over wider gaps
  bool remove_offset = false;    // remove the mean north, east, up error: a truth of unknown datum
  // Course over ground above this speed replaces the yaw where the truth has none.
  double course_speed_m_s = 0.7;
  // If set, rad/s: errors of yaw against the course are also given separately for epochs at which
  // the course turns more slowly.
  std::optional<double> max_course_rate;
  std::optional<GpsTime> from, to;   // evaluate only this span
  double antenna_offset_up_m = 0.0;  // added to the truth's height
};

// The error at one epoch.
struct ErrorSample {
  GpsTime time;
  Eigen::Vector3d neu = Eigen::Vector3d::Zero();  // m, solution minus truth
  std::optional<Eigen::Vector3d> velocity_neu;    // m/s
  std::array<std::optional<double>, 3> rpy;       // rad, wrapped: roll, pitch, yaw
  bool yaw_from_course = false;                   // the reference was course over ground
  bool steady_course = false;                     // below max_course_rate, if that is set
  std::optional<Eigen::Vector3d> sigma_neu;       // m, as the solution states it
  std::optional<double> sigma_yaw;                // rad, as the solution states it
  StatedLevels levels;
  double horizontal() const { return neu.head<2>().norm(); }
  double three_d() const { return neu.norm(); }
};

// All errors of a solution, with the counts for its availability.
struct Comparison {
  std::vector<ErrorSample> errors;
  std::size_t solution_epochs = 0;    // within the evaluated span
  std::size_t without_truth = 0;      // those among them without truth
  std::size_t expected_epochs = 0;    // from the first to the last solution, at its interval
  std::size_t expected_in_truth = 0;  // over the truth's whole span
  double interval_s = 0.0;            // median spacing of the solution
  Eigen::Vector3d removed_offset_neu = Eigen::Vector3d::Zero();  // m
};

// Returns the truth at `time`, by a cubic where it has velocities, else linearly; nullopt outside
// the truth or in a gap.
std::optional<TrackPoint> truth_at(const Track& truth, GpsTime time, double max_gap_s);

// Returns the course over ground of the truth, rad clockwise from north; nullopt in gaps and below
// course_speed_m_s.
std::optional<double> course_at(const Track& truth, GpsTime time, const ErrorOptions& options);

// Returns whether the mean turn of the course from one second before to one second after is slower
// than max_course_rate. In a turn, an antenna carried at arm's length moves sideways, and the
// course is not its heading.
bool course_is_steady(const Track& truth, GpsTime time, const ErrorOptions& options);

// Compares a solution with the truth, which is interpolated to the solution's times.
Comparison compare(const Track& solution, const Track& truth, const ErrorOptions& options);

}  // namespace leonav
