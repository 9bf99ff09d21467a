// Heading from velocity matching: what the accelerometers integrate over a window against what the
// velocity changed by.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>
#include <complex>
#include <optional>

#include "core/ins/imu.h"

namespace leonav {

// Needs no assumption on how the vehicle moves: in a curve, or while speeding up or braking, the
// velocity's change over ground and the integrated specific force are one vector in two frames, and
// the angle between the frames is the heading. Tells driving in reverse from driving forward, which
// a course cannot.
//
// In complex numbers (north + j east; levelled + j right), with the velocities v_i of a window:
//   v_i = v_0 + c (u_i - d t_i - a B_i - w G_i),
// u the integral of the levelled specific force, d what the level is off by, a and w the horizontal
// accelerometer and gyro biases, B and G their integrals, c = exp(j heading offset). Linear in v_0,
// c, c d, c a, c w: weighted least squares with what is known of the errors beforehand. That |c|
// comes out as 1, and the residuals as the velocities' sigmas say, checks the answer.
class VelocityMatching {
 public:
  struct Config {
    double window_s = 15.0;
    // From the IMU to the antenna, m: what swings it is not the vehicle's motion.
    Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
    double velocity_sigma = 0.05;    // m/s, beyond the told one: receiver's smoothing, swaying mast
    double accel_bias_sigma = 0.2;   // m/s^2, each axis
    double level_sigma = 0.1;        // rad, of roll and pitch at the window's beginning
    double accel_scale_sigma = 0.0;  // 1
  };
  explicit VelocityMatching(const Config& config) : config_(config) {}
  void reset();
  // In order of time, without holes; what is known of the gyros' bias taken out.
  void add(const ImuSample& sample);
  // The antenna's velocity at the last sample: north, east, m/s, with its sigma per component.
  // `q_lb`: the levelled attitude then, its heading arbitrary but of one zero with those before.
  // False: left out, as one of more than the window holds (40), or not finite.
  bool add_velocity(const Eigen::Vector2d& v_n, double sigma_v, const Eigen::Quaterniond& q_lb);

  struct Heading {
    double heading = 0.0;  // rad, of the body's x axis at the last sample
    double sigma = 0.0;    // rad
  };
  struct Match {
    Heading heading;
    Eigen::Quaterniond q_lb = Eigen::Quaterniond::Identity();  // then, levelled by the velocities
    double level_sigma = 0.0;                                  // rad, of roll and pitch
    double misfit = 0.0;  // squared residuals over their variance: 1 when all is well
  };
  // `rate_sigma`: of the gyros' bias as far as it has not been taken out, rad/s per axis. `known`:
  // what else tells the heading then; it takes part. nullopt: the window holds too little for a
  // heading within 20 degrees, or does not fit.
  std::optional<Match> match(double rate_sigma,
                             const std::optional<Heading>& known = std::nullopt) const;

 private:
  using Complex = std::complex<double>;
  static constexpr std::size_t kCapacity = 40;
  // Sums over samples, in the body frame where they begin.
  struct Increment {
    double seconds = 0.0;
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  // body at the end to that frame
    Eigen::Vector3d velocity_b = Eigen::Vector3d::Zero();
    Complex bias_path, rate_path;  // integral of exp(j yaw), and the integral of that
  };
  struct Entry {
    Increment since;  // the entry before
    Eigen::Quaterniond q_lb;
    Eigen::Vector3d swing_b;  // of the antenna about the IMU, m/s
    Complex v_n;
    double sigma_v;
  };
  static constexpr int kUnknowns = 5;
  struct Solution;
  Solution solve(const Eigen::Quaterniond& first_q_lb, double rate_sigma,
                 const std::optional<Heading>& known) const;

  Config config_;
  Increment current_;
  Eigen::Vector3d rate_b_ = Eigen::Vector3d::Zero();  // of the last sample
  boost::container::static_vector<Entry, kCapacity> entries_;
};

}  // namespace leonav
