// LastingErrors finds errors of codes that stay for minutes, as those of wrong orbits and clocks
// do.
#pragma once
#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// A reflection ends when the vehicle has passed the wall, the error of an orbit stays. The
// residuals of each satellite's codes are averaged in blocks: of 30 s and 150 m of way, whichever
// is longer, but at most 15 min; of a LEO satellite 10 s. With m the mean of its last four to eight
// blocks, m_0 the median of these means over its system, whose clock one wrong satellite moves, and
// b^2 half the mean square of the differences of successive blocks (von Neumann, Annals of
// Mathematical Statistics 12, 1941), a satellite's error lasts if
//   d > 3 b,  d > 3 c,  d > 1 m,   d = min(|m|, |m - m_0|),
// c being the 1 sigma that is stated of what lasts in its codes. If a third of the satellites of a
// system that are in view, of four or more, and at least three have such errors, its orbits or
// clocks are wrong, until for four minutes a sixth or fewer have, or one. The variance of its
// ranges is then, with the redundancy of each residual,
//   L^2 = sum of m^2 / sum of redundancy, times n/4.
// Errors of one cause, a shift of time for one, are alike for all satellites and do not average, so
// that the position is as uncertain as four satellites leave it; n are those of all wrong systems.
// Where most of the systems with four satellites in view are wrong, the others are taken to be as
// wrong as the best of these: residuals do not show whose fault it is.
class LastingErrors {
 public:
  // One code of one epoch.
  struct Sample {
    SatelliteId satellite;
    double residual_m = 0.0;
    double redundancy = 0.0;       // share of the code's own error that its residual shows
    double stated_variance = 0.0;  // c^2: Measurement::lasting_variance
    double speed_m_s = 0.0;        // of the antenna
  };
  void add(const Sample& sample, GpsTime time);
  // Ends the epoch and decides, from the blocks that are complete, which systems are wrong.
  void end_epoch(GpsTime time);
  void reset() { *this = LastingErrors(); }
  // Returns L, m, of a system; 0: none has been found.
  double sigma_m(System system) const { return sigma_m_[index_of(system)]; }
  // Returns the largest of all systems.
  double largest_sigma_m() const { return *std::max_element(sigma_m_.begin(), sigma_m_.end()); }
  // Returns the same of a single range, and only of what the system's own codes show.
  double own_sigma_m(System system) const { return systems_[index_of(system)].range_sigma_m; }

  // What the last epoch has changed.
  struct Change {
    // The largest own_sigma_m() of the systems that it has found, or whose error it has found to be
    // twice what it was, m; 0: there are none.
    double found_m = 0.0;
    // 1 sigma by which the ranges are worse than those that have led the position here, m: the root
    // of how much a system's L^2 has grown since it last did; 0: none has grown by half.
    double growth_m = 0.0;
    // The errors of the codes to come are others than those before: they have grown, or end.
    bool codes_differ = false;
  };
  const Change& change() const { return change_; }

 private:
  static constexpr std::size_t kBlocks = 8;
  // Of the codes of one satellite: sums while it is under way, then means.
  struct Block {
    double progress = 0.0;  // 0 to 1
    double residual = 0.0, redundancy = 0.0, stated_variance = 0.0;
    int count = 0;
  };
  struct Track {
    SatelliteId satellite;
    GpsTime last_time;
    Block block;                                             // under way
    boost::container::static_vector<Block, kBlocks> blocks;  // the last ones
  };
  // Over the blocks of a track.
  struct Mean {
    double residual = 0.0;  // m
    double scatter = 0.0;   // b^2
    double redundancy = 0.0, stated_variance = 0.0;
  };
  struct Evidence {
    int in_view = 0;  // satellites, those included that cannot be tested yet
    int satellites = 0, lasting = 0;
    double squares = 0.0, redundancies = 0.0;
  };
  struct Verdict {
    double range_sigma_m = 0.0;    // own_sigma_m(); 0: not wrong
    double reported_m = 0.0;       // the same when it was last found
    double allowed_sigma_m = 0.0;  // L that the position allows for
    GpsTime tested, wrong_until;
  };
  Track* find(SatelliteId satellite, GpsTime time);
  static Mean mean_of(const Track& track);
  Evidence evaluate(System system, GpsTime time) const;
  static void decide(const Evidence& evidence, GpsTime time, Verdict* verdict);
  void note_change();

  boost::container::static_vector<Track, kMaxArcs> tracks_;
  std::array<Verdict, kSystemCount> systems_;
  std::array<double, kSystemCount> sigma_m_{};
  Change change_;
};

}  // namespace leonav
