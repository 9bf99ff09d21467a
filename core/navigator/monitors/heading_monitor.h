// HeadingMonitor finds a wrong heading of the filter by velocities that do not depend on the
// filter.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "core/inertial/alignment/alignment.h"
#include "core/inertial/alignment/course_window.h"
#include "core/inertial/alignment/velocity_matching.h"
#include "core/inertial/strapdown/imu.h"

namespace leonav {

// A heading that was configured wrongly or found from reflected signals does not show in the
// innovations of one epoch: robust weights hide them, and the filter keeps the error. Over a window
// it does show. The innovation here is an independent heading minus the filter's. The independent
// heading comes from velocity matching (velocities of point solutions against integrated specific
// force) or, for a vehicle that moves along its axis, from the course against the gyros.
class HeadingMonitor {
 public:
  HeadingMonitor(const AlignmentConfig& config, const ImuErrorModel& imu);

  // Starts monitoring a filter that has just got its attitude, with its gyro bias (rad/s) and the
  // largest sigma of an axis.
  void start(const Eigen::Vector3d& gyro_bias_b, double gyro_bias_sigma);
  bool started() const { return started_; }
  void stop() { started_ = false; }
  // Adds samples in order of time. After a gap the windows start anew.
  void add(std::span<const ImuSample> block);

  // The filter's estimate at the last sample.
  struct Filter {
    Eigen::Quaterniond q_nb;      // body to north, east, down
    double heading_sigma;         // rad
    Eigen::Vector3d gyro_bias_b;  // rad/s
    double gyro_bias_sigma;       // rad/s, largest of the axes
  };
  // Adds the antenna's velocity at the last sample by a point solution: `v_n` north and east,
  // `sigma_v` per component, m/s. Returns the error of the filter's heading (rad; independent minus
  // filter's) once it has been significant for two seconds, for half a minute if the heading was
  // confirmed before, in each of at least three velocities that the window of velocity matching
  // accepts.
  std::optional<double> add_velocity(const Eigen::Vector2d& v_n, double sigma_v,
                                     const Filter& filter);

 private:
  void clear_windows();
  void level(const Eigen::Quaterniond& q_nb);
  void add_course(const Eigen::Vector2d& v_n, double sigma_v);
  std::optional<double> course_innovation(double heading) const;

  AlignmentConfig config_;
  VelocityMatching matching_;
  CourseWindow courses_;
  bool started_ = false;
  bool confirmed_ = false;  // by velocity matching, since start()
  Eigen::Vector3d gyro_bias_b_ = Eigen::Vector3d::Zero();
  double gyro_bias_sigma_ = 0.0;
  GpsTime last_time_;
  // Body to levelled frame: heading by the gyros from an arbitrary zero, roll and pitch from the
  // filter.
  Eigen::Quaterniond q_lb_ = Eigen::Quaterniond::Identity();
  double seconds_ = 0.0;  // duration of all samples
  // The gyros' yaw (rad) and `seconds_` at the last velocity with a course.
  struct Course {
    double yaw, seconds;
  };
  std::optional<Course> last_course_;
  bool forward_ = false;                // since the last stop it was faster than it goes in reverse
  int consecutive_contradictions_ = 0;  // velocities in a row
  double contradicted_since_ = 0.0;     // `seconds_` at the first one
};

}  // namespace leonav
