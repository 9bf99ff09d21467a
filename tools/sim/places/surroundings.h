// Surroundings computes which signals reach the vehicle between houses, below decks and through
// leaves.
#pragma once
#include <vector>

#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/signals/satellite.h"
#include "tools/sim/motion/spline_motion.h"
#include "tools/sim/places/odometer.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// The vehicle's place at one instant.
struct PlaceNow {
  const Place* place = nullptr;
  std::size_t segment = 0;
  double course = 0.0;       // rad, of vehicle and street
  double course_rate = 0.0;  // rad/s
  double travelled_m = 0.0, speed_m_s = 0.0;
};

// The way in which one satellite's signals arrive.
struct Reception {
  bool possible = true;
  bool line_of_sight = true;  // possibly along an edge or through leaves
  double loss_db = 0.0;       // relative to free sight
  // For a reflection that arrives instead: distance behind the mirror, and its addition to the
  // range.
  double mirror_m = 0.0, extra_m = 0.0, extra_m_s = 0.0;
  unsigned route = 0;  // 0: direct; otherwise a different number for each wall
};

// The geometry is that of a straight street with houses along it, a deck above it, or leaves.
//
// A house that hides a satellite passes a signal diffracted at its roof (knife edge, Rec. ITU-R
// P.526, 4.1) and one reflected by the houses across the street; the stronger one is received.
class Surroundings {
 public:
  // Throws std::runtime_error if segments are not in order. `motion` must outlive this object.
  Surroundings(const Scenario& scenario, const SplineMotion& motion);

  PlaceNow at(double t) const;
  // Returns the reception. `direction` and its rates (rad/s) are as seen by the antenna.
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

// Returns the loss of a knife edge, dB. `clearance_m` is the distance by which the ray passes the
// edge (negative: through the shadow) at `distance_m` from the antenna.
double knife_edge_loss_db(double clearance_m, double distance_m, double wavelength_m);

}  // namespace leonav::sim
