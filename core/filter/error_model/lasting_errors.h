// LastingErrors finds errors of codes that stay for minutes, as those of wrong orbits and clocks
// do.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// A reflection ends when the vehicle has passed the wall, the error of an orbit stays. The
// residuals of each satellite's codes are averaged in blocks: half a minute of driving, five
// minutes of standing, ten seconds of a LEO satellite. With m the mean of its last four to eight
// blocks, and b^2 half the mean square of the differences of successive ones (von Neumann, Annals
// of Mathematical Statistics 12, 1941), a satellite's error lasts if
//   |m| > 3 b,  |m| > 5 c,  |m| > 1 m,
// c being the 1 sigma that its orbit, clock and atmosphere are stated to have. If a third of a
// system's satellites, and at least three, have such errors, its orbits or clocks are wrong, until
// less than a sixth have. The variance of its ranges is then, with the redundancy of each residual,
//   sum of m^2 / sum of redundancy, times n/4.
// Errors of one cause, a shift of time for one, are alike for all satellites and do not average, so
// that the position is as uncertain as four satellites leave it, however many (n) are seen. Where
// most systems are wrong the others are taken to be as wrong as the best of these: residuals do not
// show whose fault it is.
class LastingErrors {
 public:
  // One code of one epoch.
  struct Sample {
    SatelliteId satellite;
    std::uint32_t orbit = 0;  // identity of its orbit; another one begins anew
    double residual_m = 0.0;  // of the code
    double redundancy = 0.0;  // share of the code's own error that its residual shows
    double stated_variance =
        0.0;  // m^2, of what lasts, with the square of sigma_m() if that is in it
    bool standing = false;
  };
  void add(const Sample& sample, GpsTime time);
  // Ends the epoch: decides anew.
  void end_epoch(GpsTime time);
  void reset() { *this = LastingErrors(); }
  // Returns 1 sigma of the ranges' errors beyond what is stated, m; 0: none has been found.
  double sigma_m(System system) const { return alike_ * sigma_m_[index_of(system)]; }

 private:
  static constexpr std::size_t kBlocks = 8;
  struct Track {
    SatelliteId satellite;
    std::uint32_t orbit = 0;
    GpsTime last_time;
    double progress = 0.0;                                        // of the block under way, 0 to 1
    double residuals = 0.0, redundancies = 0.0, variances = 0.0;  // sums over the block
    int count = 0;
    boost::container::static_vector<double, kBlocks> means;  // the last blocks', m
    double redundancy = 0.0, stated_variance = 0.0;          // of the last block
  };
  Track* find(const Sample& sample, GpsTime time);
  struct Evidence {
    int satellites = 0, lasting = 0;
    double squares = 0.0, redundancies = 0.0;
  };
  Evidence evaluate(System system) const;

  boost::container::static_vector<Track, kMaxArcs> tracks_;
  std::array<double, kSystemCount> sigma_m_{};  // of single ranges
  double alike_ = 1.0;
};

}  // namespace leonav
