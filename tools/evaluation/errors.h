// Errors of a solution against a truth, epoch by epoch.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "tools/evaluation/track.h"

namespace leonav {

struct ErrorOptions {
  double max_truth_gap_s = 2.0;   // the truth is not interpolated over wider holes
  bool remove_offset = false;     // remove the mean north, east, up error: a truth of unknown datum
  double course_speed_m_s = 0.7;  // where the truth has no yaw: course over ground above this speed
  // rad/s; set: of the yaw from course, what falls where the course turns slower is given too
  std::optional<double> max_course_rate;
  std::optional<GpsTime> from, to;   // judge only this span
  double antenna_offset_up_m = 0.0;  // added to the truth's height
};

struct ErrorSample {
  GpsTime time;
  Eigen::Vector3d neu = Eigen::Vector3d::Zero();  // m, solution minus truth
  std::optional<Eigen::Vector3d> velocity_neu;    // m/s
  std::array<std::optional<double>, 3> rpy;       // rad, wrapped: roll, pitch, yaw
  bool yaw_from_course = false;                   // the reference was course over ground
  bool steady_course = false;                     // below max_course_rate, if that is set
  std::optional<Eigen::Vector3d> sigma_neu;       // m, as the solution states it
  double horizontal() const { return neu.head<2>().norm(); }
  double three_d() const { return neu.norm(); }
};

struct Comparison {
  std::vector<ErrorSample> errors;
  std::size_t solution_epochs = 0;  // within the judged span
  std::size_t without_truth = 0;    // of these, not comparable
  std::size_t expected_epochs = 0;  // from the first to the last answer at the solution's interval
  std::size_t expected_in_truth = 0;  // the same over the truth's whole span
  double interval_s = 0.0;            // median spacing of the solution
  Eigen::Vector3d removed_offset_neu = Eigen::Vector3d::Zero();  // m
};

// The truth at `time`: cubic where it has velocities, else linear. nullopt: outside, or in a hole.
std::optional<TrackPoint> truth_at(const Track& truth, GpsTime time, double max_gap_s);

// Course over ground of the truth (rad, clockwise from north); nullopt in holes and below
// course_speed_m_s.
std::optional<double> course_at(const Track& truth, GpsTime time, const ErrorOptions& options);

// True where the course turned slower than max_course_rate, on the mean of one second before to one
// second after. An antenna that is carried at arm's length goes sideways in a turn: there its
// course is not its heading, whatever the heading's error.
bool course_is_steady(const Track& truth, GpsTime time, const ErrorOptions& options);

// Interpolates the truth (cubic where it has velocities, else linear) to the solution's times.
Comparison compare(const Track& solution, const Track& truth, const ErrorOptions& options);

}  // namespace leonav
