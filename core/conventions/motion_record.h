// What the IMU and the receiver's velocity, each by itself, say of the same stretches of time.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>

#include "core/gnss/point_solution.h"
#include "core/ins/imu.h"

namespace leonav {

// A second, more or less, between two velocities of the antenna.
struct MotionSecond {
  GpsTime time;          // end
  double seconds = 0.0;  // from the velocity before to the one at the end
  bool has_imu = false;  // of most of the time; else the next three are zero
  Eigen::Vector3d force_b = Eigen::Vector3d::Zero();  // mean specific force, m/s^2
  Eigen::Vector3d rate_b = Eigen::Vector3d::Zero();   // mean, rad/s
  double force_mean_square = 0.0;                     // mean of |specific force|^2, (m/s^2)^2
  bool has_course = false;           // the antenna moved all the time, in a direction well known
  double speed = 0.0;                // horizontal, the lower of the two, m/s
  double course_rate = 0.0;          // rad/s, clockwise from above
  double along = 0.0, across = 0.0;  // horizontal acceleration: forward, to the right, m/s^2
};

// From where on a velocity's direction says how the body turns.
struct CourseLimits {
  double min_speed_m_s, max_sigma;  // of the direction, rad
};
// At less, who is in a vehicle stands, or a reflected signal turns.
inline constexpr CourseLimits kInVehicle{2.0, 0.1};
inline constexpr CourseLimits kOnFoot{0.7, 0.2};

class MotionRecord {
 public:
  static constexpr std::size_t kCapacity = 256;
  static constexpr double kShortest_s = 0.9;  // of a second in the record

  explicit MotionRecord(CourseLimits limits = kInVehicle) : limits_(limits), seconds_(kCapacity) {}
  void clear();
  void add(const ImuSample& sample);  // as the navigator uses it: body axes
  // Whether a velocity at `time` would end a second.
  bool is_due(GpsTime time) const;
  // To be called at every epoch that is due; without a solution, or one without a velocity, what
  // ends here has no course. nullptr where nothing ends here.
  const MotionSecond* end_second(GpsTime time, const PointSolution* point);

  const boost::circular_buffer<MotionSecond>& seconds() const { return seconds_; }
  double imu_interval_s() const { return imu_interval_s_; }  // of the last sample

 private:
  struct Velocity {
    Eigen::Vector2d north_east = Eigen::Vector2d::Zero();
    double sigma = 0.0;
  };
  void put_course(const Velocity& from, const Velocity& to, MotionSecond* second) const;

  CourseLimits limits_;
  boost::circular_buffer<MotionSecond> seconds_;
  GpsTime last_time_;  // where the current second began
  std::optional<Velocity> last_velocity_;
  Eigen::Vector3d angle_b_ = Eigen::Vector3d::Zero(), velocity_b_ = Eigen::Vector3d::Zero();
  double force_squared_ = 0.0, imu_s_ = 0.0, imu_interval_s_ = 0.0;
};

}  // namespace leonav
