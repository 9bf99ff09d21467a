#include "core/gnss/orbits/satellite_state.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

// The constants with which the elements of each message were fitted.
struct OrbitConstants {
  double mu;             // m^3/s^2
  double rotation_rate;  // rad/s
};

OrbitConstants constants_of(System system) {
  switch (system) {
    case System::kGalileo:
      return {3.986004418e14, 7.2921151467e-5};  // OS-SIS-ICD 5.1.1
    case System::kBeidou:
      return {3.986004418e14, 7.2921150e-5};  // BDS-SIS-ICD-B1I 5.2.4.12
    case System::kGps:
    case System::kLeo:
      break;
  }
  return {3.986005e14, 7.2921151467e-5};  // IS-GPS-200 table 20-IV
}

// Returns the time of week of toe in the message's own time scale, to which the longitude of the
// node refers.
double own_toe_tow(const Ephemeris& ephemeris) {
  const bool beidou = ephemeris.satellite.system == System::kBeidou;
  return ephemeris.toe.plus_nanoseconds(beidou ? kBeidouMinusGpsSeconds * kNanosecondsPerSecond : 0)
      .tow_s();
}

// Solves E - e sin E = M by Newton's method; for e < 0.2 three steps reach the last bit, so the
// bound on the steps is never reached.
double eccentric_anomaly(double mean_anomaly, double e) {
  double E = mean_anomaly + e * std::sin(mean_anomaly);
  for (int i = 0; i < 8; ++i) {
    const double step = (E - e * std::sin(E) - mean_anomaly) / (1.0 - e * std::cos(E));
    E -= step;
    if (std::abs(step) < 1e-15) break;
  }
  return E;
}

// The position within the orbital plane, with its rates.
struct InPlane {
  double radius, radius_rate;
  double latitude, latitude_rate;  // argument of latitude u
  double inclination, inclination_rate;
  double e_sin_E, e_sin_E_rate;  // for the clock
};

InPlane in_plane(const Ephemeris& eph, double mu, double tk) {
  const double A0 = eph.sqrt_a * eph.sqrt_a;
  const double A = A0 + eph.a_dot * tk;
  const double e = eph.eccentricity;
  const double n0 = std::sqrt(mu / (A0 * A0 * A0)) + eph.delta_n;
  const double mean_n = n0 + 0.5 * eph.delta_n_dot * tk;  // over tk
  const double n = n0 + eph.delta_n_dot * tk;             // rate of the mean anomaly at tk
  const double E = eccentric_anomaly(std::remainder(eph.m0 + mean_n * tk, 2.0 * kPi), e);
  const double sin_E = std::sin(E), cos_E = std::cos(E);
  const double q = 1.0 - e * cos_E;
  const double E_rate = n / q;
  const double root = std::sqrt(1.0 - e * e);
  const double phi = std::atan2(root * sin_E, cos_E - e) + eph.omega;
  const double phi_rate = E_rate * root / q;
  const double s2 = std::sin(2.0 * phi), c2 = std::cos(2.0 * phi);

  InPlane p;
  p.latitude = phi + eph.cus * s2 + eph.cuc * c2;
  p.latitude_rate = phi_rate * (1.0 + 2.0 * (eph.cus * c2 - eph.cuc * s2));
  p.radius = A * q + eph.crs * s2 + eph.crc * c2;
  p.radius_rate =
      A * e * sin_E * E_rate + 2.0 * phi_rate * (eph.crs * c2 - eph.crc * s2) + eph.a_dot * q;
  p.inclination = eph.i0 + eph.i_dot * tk + eph.cis * s2 + eph.cic * c2;
  p.inclination_rate = eph.i_dot + 2.0 * phi_rate * (eph.cis * c2 - eph.cic * s2);
  p.e_sin_E = e * sin_E;
  p.e_sin_E_rate = e * cos_E * E_rate;
  return p;
}

// Turns the position out of the orbital plane; `node` is the longitude of the ascending node in the
// wanted frame.
void to_frame(const InPlane& p, double node, double node_rate, SatelliteState* state) {
  const double su = std::sin(p.latitude), cu = std::cos(p.latitude);
  const double si = std::sin(p.inclination), ci = std::cos(p.inclination);
  const double sn = std::sin(node), cn = std::cos(node);
  const double x = p.radius * cu, y = p.radius * su;
  const double vx = p.radius_rate * cu - y * p.latitude_rate;
  const double vy = p.radius_rate * su + x * p.latitude_rate;
  const double y_ci_rate = vy * ci - y * si * p.inclination_rate;

  state->p_e = {x * cn - y * ci * sn, x * sn + y * ci * cn, y * si};
  state->v_e = {vx * cn - y_ci_rate * sn - node_rate * state->p_e.y(),
                vx * sn + y_ci_rate * cn + node_rate * state->p_e.x(),
                vy * si + y * ci * p.inclination_rate};
}

// Geostationary elements are fitted in an inertial frame tilted by 5 degrees, where the inclination
// is not near zero (BDS-SIS-ICD-B1I table 5-11). Rz(rate tk) Rx(-5 deg) turns that frame into ECEF.
void tilted_to_ecef(double rate, double tk, SatelliteState* state) {
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(5.0 * kPi / 180.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d spin =
      Eigen::AngleAxisd(-rate * tk, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  state->p_e = spin * (tilt * state->p_e);
  state->v_e = spin * (tilt * state->v_e);
  state->v_e -= Eigen::Vector3d(0.0, 0.0, rate).cross(state->p_e);
}

void set_clock(const Ephemeris& eph, double mu, const InPlane& p, GpsTime time,
               SatelliteState* state) {
  const double t = seconds_between(time, eph.toc);
  // -2 r.v/c^2 of a Kepler orbit is F e sqrt(A) sin E (IS-GPS-200 20.3.3.3.3.1), with which the
  // broadcast polynomial was fitted: r.v with the harmonic terms differs by 0.04 ns.
  const double F = -2.0 * std::sqrt(mu) * eph.sqrt_a / (kSpeedOfLight * kSpeedOfLight);
  state->clock_s = eph.af0 + t * (eph.af1 + t * eph.af2) + F * p.e_sin_E;
  state->clock_drift = eph.af1 + 2.0 * t * eph.af2 + F * p.e_sin_E_rate;
}

// This sigma applies where the message refuses to predict its accuracy.
constexpr double kNoPredictionSigma = 50.0;  // m
// A message that claims a better accuracy has rounded it: today's broadcast products are not
// better.
constexpr double kBestBroadcastSigma = 0.5;  // m
// The sigma grows with age: two hours away from toe add about 0.7 m.
constexpr double kSigmaGrowth = 1e-4;  // m/s

bool within(double value, double bound) { return std::abs(value) <= bound; }  // false for NaN

bool message_fits(const Ephemeris& ephemeris) {
  switch (ephemeris.satellite.system) {
    case System::kGalileo:
      return ephemeris.message == NavigationMessage::kGalileoInav ||
             ephemeris.message == NavigationMessage::kGalileoFnav;
    case System::kBeidou:
      // Satellites in geostationary orbits send no B1C.
      return ephemeris.message == NavigationMessage::kBeidouD1 ||
             ephemeris.message == NavigationMessage::kBeidouD2 ||
             (ephemeris.message == NavigationMessage::kBeidouCnav1 &&
              !is_beidou_geostationary(ephemeris.satellite));
    case System::kGps:
    case System::kLeo:
      return ephemeris.message == NavigationMessage::kGpsLnav;
  }
  return false;
}

bool sane_times(const Ephemeris& ephemeris) {
  if (ephemeris.toe.nanoseconds() <= 0 || ephemeris.toc.nanoseconds() <= 0) return false;
  if (ephemeris.transmission_time.nanoseconds() < 0) return false;
  return within(seconds_between(ephemeris.toe, ephemeris.toc), 86400.0);
}

// Bounds of the rates that not every message has, which contain the ranges of the fields.
struct RateBounds {
  double a_dot;        // m/s
  double delta_n_dot;  // rad/s^2
};
RateBounds rate_bounds(const Ephemeris& eph) {
  if (eph.satellite.system == System::kLeo) return {30.0, 1e-8};
  if (eph.message == NavigationMessage::kBeidouCnav1) return {8.0, 1e-10};
  return {0.0, 0.0};
}

bool sane_orbit(const Ephemeris& eph) {
  const double A = eph.sqrt_a * eph.sqrt_a;
  const bool leo = eph.satellite.system == System::kLeo;
  // LEO satellites are 120 to 3600 km up, others from below GPS to above the geostationary ring.
  if (!(A >= (leo ? 6.5e6 : 2.4e7) && A <= (leo ? 1.0e7 : 4.5e7)) || !(eph.sqrt_a > 0.0)) {
    return false;
  }
  if (!(eph.eccentricity >= 0.0 && eph.eccentricity < 0.2)) return false;
  for (const double angle : {eph.m0, eph.omega0, eph.i0, eph.omega}) {
    if (!within(angle, 2.0 * kPi + 1e-6)) return false;
  }
  // These bounds contain the ranges of the messages' fields. A LEO satellite, being lower, moves
  // more: its elements, fitted to minutes of its orbit, take up what J2 does in that time.
  const double rate = leo ? 1e-5 : 1e-6;
  const RateBounds rates = rate_bounds(eph);
  return within(eph.delta_n, rate) && within(eph.omega_dot, 1e-5) && within(eph.i_dot, rate) &&
         within(eph.a_dot, rates.a_dot) && within(eph.delta_n_dot, rates.delta_n_dot) &&
         within(eph.cuc, 1e-2) && within(eph.cus, 1e-2) && within(eph.cic, 1e-2) &&
         within(eph.cis, 1e-2) && within(eph.crc, 1e5) && within(eph.crs, 1e5);
}

bool sane_clock(const Ephemeris& eph) {
  return within(eph.af0, 0.1) && within(eph.af1, 1e-6) && within(eph.af2, 1e-12) &&
         within(eph.group_delay_s[0], 1e-6) && within(eph.group_delay_s[1], 1e-6) &&
         within(eph.accuracy_m, 1e5);
}

}  // namespace

SatelliteState broadcast_state(const Ephemeris& ephemeris, GpsTime time) {
  const OrbitConstants constants = constants_of(ephemeris.satellite.system);
  const double tk = seconds_between(time, ephemeris.toe);
  const InPlane p = in_plane(ephemeris, constants.mu, tk);
  const double node_at_toe = ephemeris.omega0 - constants.rotation_rate * own_toe_tow(ephemeris);

  SatelliteState state;
  if (is_beidou_geostationary(ephemeris.satellite)) {
    to_frame(p, node_at_toe + ephemeris.omega_dot * tk, ephemeris.omega_dot, &state);
    tilted_to_ecef(constants.rotation_rate, tk, &state);
  } else {
    const double node_rate = ephemeris.omega_dot - constants.rotation_rate;
    to_frame(p, node_at_toe + node_rate * tk, node_rate, &state);
  }
  set_clock(ephemeris, constants.mu, p, time, &state);
  state.age_s = std::abs(tk);
  const double claimed = ephemeris.accuracy_m < 0.0
                             ? kNoPredictionSigma
                             : std::max(ephemeris.accuracy_m, kBestBroadcastSigma);
  state.sigma_m = std::hypot(claimed, kSigmaGrowth * state.age_s);
  state.source = OrbitSource::kBroadcast;
  state.at_antenna = true;
  return state;
}

bool is_sane(const Ephemeris& ephemeris) {
  return is_valid(ephemeris.satellite) && message_fits(ephemeris) && sane_times(ephemeris) &&
         sane_orbit(ephemeris) && sane_clock(ephemeris);
}

}  // namespace leonav
