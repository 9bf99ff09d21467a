// SatelliteFaultMonitor finds a satellite whose carrier drifts away from what the others show: by
// its clock, its orbit, or a spoofer.
#pragma once
#include <boost/container/static_vector.hpp>
#include <optional>

#include "core/navigator/monitors/filter_monitor.h"

namespace leonav {

// One carrier of an update.
struct CarrierInnovation {
  SatelliteId satellite;
  SignalCode code;
  double innovation_m = 0.0, residual_m = 0.0;
  double sigma_m = 0.0;  // of the measurement alone
};
using CarrierInnovations = boost::container::static_vector<CarrierInnovation, kMaxArcs>;

// Returns the carriers of the filter's last update, but for those whose arc began with it.
CarrierInnovations carrier_innovations(const FilterEvidence& evidence);

// A satellite whose carrier drifts away from the others'.
struct SatelliteFault {
  SatelliteId satellite;
  double followed_m = 0.0;  // so much of its error the filter has taken up, as a range
};

// What the filter has followed of the carriers in the last minutes, apart from the clock.
struct FollowedRange {
  double range_m = 0.0;
  double usual_m = 0.0;  // of all carriers: 1 sigma without a fault
};

using ExcludedSatellites = boost::container::static_vector<SatelliteId, kMaxArcs>;

// A ramp of centimetres a second stays within the sigma of a single innovation, because the
// ambiguity follows it; but then all innovations have one sign. Tested is the sum of a satellite's
// innovations, one a second,
//   T = sum(m^i u_i) / sqrt(sum(m^2i)),   u = (innovation - clock) / (s sigma)
// with the memory m of 200 samples; s is the size of such innovations that is usual at the time
// (median of all satellites), so that the test does not lean on configured sigmas. Averaged
// innovations: Diesel and Luu, GPS/IRS AIME, ION GPS 1995. The satellite with the largest |T| is
// excluded if that exceeds 20: normal white errors reach five, carriers between houses sixteen.
class SatelliteFaultMonitor {
 public:
  // Adds an update and returns the satellite that it convicts, which is excluded from then on.
  std::optional<SatelliteFault> add(const CarrierInnovations& carriers, GpsTime time);
  // Returns the satellites that are not to be used at `time`: for half an hour each.
  ExcludedSatellites excluded(GpsTime time) const;
  // Returns what has been followed of a carrier; nullopt: it, or what is usual, is not known.
  std::optional<FollowedRange> followed_range(SatelliteId satellite, SignalCode code) const;
  // Clears the sums: those of another filter's innovations say nothing. With `time_begins_anew` it
  // forgets the exclusions too.
  void filter_restarted(bool time_begins_anew);

 private:
  struct Track {
    SatelliteId satellite;
    SignalCode code;
    GpsTime last;
    double pending = 0.0;  // innovations since the last sample, in sigmas
    double sum = 0.0, squares = 0.0;
    double followed_m = 0.0;
    double statistic() const;
  };
  struct Exclusion {
    SatelliteId satellite;
    GpsTime end;
  };

  void collect(const CarrierInnovations& carriers, GpsTime time);
  Track* track_of(SatelliteId satellite, SignalCode code, GpsTime time);
  // Turns what is pending into one sample of every track that has been seen at `time`. Returns
  // their number.
  std::size_t take_samples(GpsTime time);

  boost::container::static_vector<Track, kMaxArcs> tracks_;
  boost::container::static_vector<Exclusion, kMaxArcs> exclusions_;
  GpsTime begun_, last_sample_;
  double scale_ = 0.0;             // s; 0: not known
  double usual_followed_m_ = 0.0;  // 0: not known
};

}  // namespace leonav
