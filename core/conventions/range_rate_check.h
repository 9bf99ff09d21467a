// How fast codes change against what the Dopplers say: their sign, their unit, their band.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>

#include "core/capacity.h"
#include "core/conventions/convention.h"
#include "core/gnss/observation.h"

namespace leonav {

// Satellites of one system come and go at rates that differ by hundreds of metres per second: in a
// few epochs the codes tell the Dopplers' factor to a percent, whatever the receiver's clock does.
class RangeRateCheck {
 public:
  void clear() { *this = RangeRateCheck(); }
  void add(const RawEpoch& epoch);
  ConventionFinding judge() const;
  bool is_right() const;  // known to be

 private:
  // Sums of the codes' rates y and the Dopplers' x, in m/s.
  struct Sums {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    int epochs = 0;
    void add(const Sums& epoch);  // without its means: those are the receiver's clock
    bool known() const;
    bool surely_not_one() const;  // its factor
    double factor() const { return xy / xx; }
  };
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
  bool is_named_as_another(System system, std::size_t band) const;

  Table sums_{};
  boost::container::static_vector<Last, kMaxObservations> last_;
  GpsTime last_time_;
};

}  // namespace leonav
