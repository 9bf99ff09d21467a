#include "tools/sim/motion/spline_motion.h"

#include <cmath>

#include "core/earth/rotation.h"

namespace leonav {
namespace {

struct Attitude {
  EulerAngles angles;
  EulerAngles rates;
};

// Returns the body's rate against n from the rates of roll, pitch and yaw about their axes.
Eigen::Vector3d body_rate(const Attitude& a) {
  const double sr = std::sin(a.angles.roll), cr = std::cos(a.angles.roll);
  const double sp = std::sin(a.angles.pitch), cp = std::cos(a.angles.pitch);
  return {a.rates.roll - a.rates.yaw * sp, a.rates.pitch * cr + a.rates.yaw * sr * cp,
          a.rates.yaw * cr * cp - a.rates.pitch * sr};
}

// Returns the Earth rate plus the transport rate of the local frame (Groves 2013, eq. 5.44).
Eigen::Vector3d omega_in_n(const Geodetic& where, const Eigen::Matrix3d& C_ne,
                           const Eigen::Vector3d& v_e) {
  const Eigen::Vector3d v_n = C_ne * v_e;
  const double east_turn = v_n.y() / (prime_vertical_radius(where.latitude) + where.height);
  const double north_turn = v_n.x() / (meridian_radius(where.latitude) + where.height);
  const Eigen::Vector3d omega_en_n(east_turn, -north_turn, -east_turn * std::tan(where.latitude));
  return kEarthRotationRate * C_ne.col(2) + omega_en_n;
}

}  // namespace

MotionInstant SplineMotion::at(double t) const {
  MotionInstant now;
  for (int axis = 0; axis < 3; ++axis) {
    const auto place = splines_.position[static_cast<std::size_t>(axis)].evaluate(t);
    now.p_e[axis] = splines_.origin_e[axis] + place.value;
    now.v_e[axis] = place.first;
    now.a_e[axis] = place.second;
  }
  const auto roll = splines_.attitude[0].evaluate(t), pitch = splines_.attitude[1].evaluate(t),
             yaw = splines_.attitude[2].evaluate(t);
  const Attitude attitude{{roll.value, pitch.value, yaw.value},
                          {roll.first, pitch.first, yaw.first}};
  const Geodetic where = to_geodetic(now.p_e);
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(where);
  const Eigen::Matrix3d C_nb = rotation_from_euler(attitude.angles);
  now.q_eb = Eigen::Quaterniond(Eigen::Matrix3d(C_ne.transpose() * C_nb)).normalized();
  now.omega_ib_b = C_nb.transpose() * omega_in_n(where, C_ne, now.v_e) + body_rate(attitude);
  return now;
}

TruthPoint SplineMotion::point(GpsTime time) const {
  const double t = seconds_between(time, start());
  const MotionInstant now = at(t);
  TruthPoint point;
  point.time = time;
  point.position = to_geodetic(now.p_e);
  point.v_n = rotation_ecef_to_ned(point.position) * now.v_e;
  point.roll = splines_.attitude[0].evaluate(t).value;
  point.pitch = splines_.attitude[1].evaluate(t).value;
  point.yaw = wrap_to_pi(splines_.attitude[2].evaluate(t).value);
  return point;
}

}  // namespace leonav
