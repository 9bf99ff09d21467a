// What of the sky the vehicle sees, and how the rest reaches it.
#pragma once
#include <vector>

#include "core/gnss/look_angles.h"
#include "core/gnss/satellite.h"
#include "tools/motion/spline_motion.h"
#include "tools/sim/places/odometer.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Where the vehicle is at one instant.
struct PlaceNow {
  const Place* place = nullptr;
  std::size_t segment = 0;
  double course = 0.0;       // rad, of vehicle and street
  double course_rate = 0.0;  // rad/s
  double travelled_m = 0.0, speed_m_s = 0.0;
};

// How one satellite's signals arrive.
struct Reception {
  bool possible = true;
  bool line_of_sight = true;  // though perhaps along an edge or through leaves
  double loss_db = 0.0;       // against free sight
  // Of a reflection that arrives instead: the way behind the mirror, and what it adds to the range.
  double mirror_m = 0.0, extra_m = 0.0, extra_m_s = 0.0;
  unsigned route = 0;  // 0 straight on; otherwise another number for each wall
};

// Geometry of a straight street with houses along it, or a deck above it, or leaves. A house that
// hides a satellite lets through what bends round its roof (knife edge, Rec. ITU-R P.526, 4.1) and
// what the houses across the street reflect; the stronger one is received.
class Surroundings {
 public:
  // Throws std::runtime_error where segments are not in order. `motion` must outlive it.
  Surroundings(const Scenario& scenario, const SplineMotion& motion);

  PlaceNow at(double t) const;
  // `direction` and its rates (rad/s) as seen by the antenna.
  Reception reception(const PlaceNow& now, SatelliteId satellite, const LookAngles& direction,
                      const LookAngles& rates) const;

 private:
  struct Wall;
  double course_at(double t) const;
  double house_height(const PlaceNow& now, int side, double along_m, unsigned* house) const;
  void pass_houses(const PlaceNow& now, const LookAngles& direction, const LookAngles& rates,
                   Reception* reception) const;
  bool reflect(const PlaceNow& now, const LookAngles& direction, const LookAngles& rates,
               Reception* reflected) const;

  const SplineMotion& motion_;
  Odometer odometer_;
  std::uint64_t seed_;
  struct Segment {
    double from_s;
    Place place;
  };
  std::vector<Segment> segments_;
};

// Loss of a knife edge, dB: `clearance_m` by which the ray passes beside it (negative: through the
// shadow) at `distance_m` from the antenna.
double knife_edge_loss_db(double clearance_m, double distance_m, double wavelength_m);

}  // namespace leonav::sim
