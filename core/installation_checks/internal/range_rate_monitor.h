// RangeRateMonitor compares the rates of codes with the Dopplers: their sign, their unit and their
// band.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>

#include "core/base/capacity.h"
#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/observation.h"
#include "core/installation_checks/convention.h"

namespace leonav {

// RangeRateMonitor fits code rate = factor * range rate of the Doppler per system and band.
//
// The mean of each epoch is removed, which removes the receiver's clock. The range rates of one
// system's satellites differ by hundreds of metres per second, so that a few epochs give the factor
// to one percent.
class RangeRateMonitor {
 public:
  // `bands`: the carriers of the LEO satellites.
  explicit RangeRateMonitor(const BandPlan& bands = {}) : bands_(bands) {}
  void clear() { *this = RangeRateMonitor(bands_); }
  // Adds an epoch of raw observations.
  void add(const RawEpoch& epoch);
  // Returns the mistake that explains the factors, or none.
  ConventionFinding evaluate() const;
  // Returns whether the factors are known and right.
  bool is_right() const;

 private:
  // Sums over the codes' rates y and the Dopplers' range rates x, in m/s.
  struct Sums {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    int epochs = 0;
    void add(const Sums& epoch);  // adds an epoch without its means, the receiver's clock
    bool known() const;
    bool differs_from_one() const;  // by five sigmas
    double factor() const { return xy / xx; }
  };
  // The last code and Doppler of one signal.
  struct Last {
    SatelliteId satellite;
    SignalCode code;
    double pseudorange_m, doppler_hz;
  };
  static constexpr std::size_t kBands = 10;
  using Table = std::array<std::array<Sums, kBands>, kSystemCount>;

  void compare(const RawEpoch& epoch, double dt);
  Sums all() const;
  double exchanged_factor(System system) const;
  bool is_mislabelled(System system, std::size_t band) const;

  double ratio_of(System system, std::size_t a, std::size_t b) const;

  BandPlan bands_;
  Table sums_{};
  boost::container::static_vector<Last, kMaxObservations> last_;
  GpsTime last_time_;
};

}  // namespace leonav
