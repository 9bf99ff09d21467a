// VelocityMatching finds the heading by comparing integrated specific force with the change of
// velocity over a window.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>
#include <complex>
#include <optional>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

inline constexpr double kLevellingGravity = 9.81;  // m/s^2; levelling needs no better

// The method needs no assumption on how the vehicle moves. In a curve, or while the speed changes,
// the change of velocity over ground and the integrated specific force are one vector in two
// frames, and the angle between the frames is the heading. It distinguishes driving in reverse from
// driving forward, which a course cannot.
//
// In complex numbers (north + j east; levelled + j right), with the velocities v_i of a window:
//   v_i = v_0 + c (u_i - d t_i - a B_i - w G_i),
// where u is the integral of the levelled specific force, d the error of the level, a and w the
// horizontal accelerometer and gyro biases, B and G their integrals, and c = exp(j heading offset).
// The equation is linear in v_0, c, c d, c a, c w and is solved by weighted least squares with
// priors on the errors. The solution is accepted only if |c| is near 1 and the residuals fit the
// sigmas of the velocities. Source: the velocity integration formula (Wu and Pan, IEEE Trans.
// Aerospace and Electronic Systems 49, 2013, part I), linear once levelled.
class VelocityMatching {
 public:
  // Settings, in SI units.
  struct Config {
    double window_s = 15.0;
    // Lever arm from the IMU to the antenna, m: the swing of the antenna is not motion of the
    // vehicle.
    Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
    double velocity_sigma = 0.05;    // m/s, beyond `sigma_v`: receiver's smoothing, swaying mast
    double accel_bias_sigma = 0.2;   // m/s^2, each axis
    double level_sigma = 0.1;        // rad, roll and pitch at the window's beginning
    double accel_scale_sigma = 0.0;  // dimensionless
  };
  explicit VelocityMatching(const Config& config) : config_(config) {}
  // Empties the window.
  void reset();
  // Adds the next sample, in order of time and without gaps, after the known gyro bias was removed.
  void add(const ImuSample& sample);
  // Adds the antenna's velocity (north, east, m/s; 1 sigma per component) at the last sample.
  //
  // `q_lb` is the levelled attitude at that instant; its heading is arbitrary but has the same zero
  // for all entries. Returns false if the velocity was left out, because the window holds no more
  // (40) or the value is not finite.
  bool add_velocity(const Eigen::Vector2d& v_n, double sigma_v, const Eigen::Quaterniond& q_lb);

  struct Heading {
    double heading = 0.0;  // rad, of the body's x axis at the last sample
    double sigma = 0.0;    // rad
  };
  // Result of the matching at the last sample.
  struct Match {
    Heading heading;
    // the attitude, levelled by the velocities
    Eigen::Quaterniond q_lb = Eigen::Quaterniond::Identity();
    double level_sigma = 0.0;  // rad, of roll and pitch
    double misfit = 0.0;       // squared residuals over their variance: 1 if the model fits
  };
  // Returns the heading, or nullopt if the window cannot give one within 20 degrees or does not fit
  // the model.
  //
  // `rate_sigma` is the 1 sigma of the remaining gyro bias, rad/s per axis. `known` is a heading
  // from another source at the last sample, which takes part in the solution.
  std::optional<Match> match(double rate_sigma,
                             const std::optional<Heading>& known = std::nullopt) const;

 private:
  using Complex = std::complex<double>;
  static constexpr std::size_t kCapacity = 40;
  // Integrals over samples, in the body frame at their beginning.
  struct Increment {
    double seconds = 0.0;
    // body at the end to body at the beginning
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    Eigen::Vector3d velocity_b = Eigen::Vector3d::Zero();
    Complex bias_path, rate_path;  // integral of exp(j yaw), and the integral of that integral
  };
  // A velocity with the motion since the one before it.
  struct Entry {
    Increment since;  // the previous entry
    Eigen::Quaterniond q_lb;
    Eigen::Vector3d swing_b;  // velocity of the antenna about the IMU, m/s
    Complex v_n;
    double sigma_v;
  };
  static constexpr int kUnknowns = 5;
  struct Solution;
  Solution solve(const Eigen::Quaterniond& first_q_lb, double rate_sigma,
                 const std::optional<Heading>& known) const;

  Config config_;
  Increment current_;
  Eigen::Vector3d rate_b_ = Eigen::Vector3d::Zero();  // rate of the last sample, rad/s
  boost::container::static_vector<Entry, kCapacity> entries_;
};

}  // namespace leonav
