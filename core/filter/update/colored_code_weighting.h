// How much the codes of one satellite may still tell, given what they have told before: of their
// errors, noise averages and the orbit's does not.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// A code's error is white noise plus a Gauss-Markov process. The filter has no state for the
// latter; instead each code counts for what it adds to all codes of its satellite before. For every
// one a filter of two states (a constant, of which nothing is known at first, and the process)
// tells how well n codes together know the constant: 1/P_n. What the n-th weighs in the large
// filter is the increase of that, 1/P_n - 1/P_(n-1). So the first counts in full, the next ones
// until noise is averaged down to the correlated part, and later ones as that part changes; the
// total is that of the best linear estimate. The constant stands for the position along the line
// of sight: this holds only as long as carriers, or a fixed antenna, keep that from epoch to epoch.
class ColoredCodeWeighting {
 public:
  struct CodeErrorModel {
    std::uint32_t orbit_issue = 0;  // another one: another error
    double random_walk = 0.0;       // m/sqrt(s), of the constant
    double disturbance_m = 0;       // 1 sigma of a step in it since the last epoch
    double correlation_time_s = 0;  // of the process
  };

  // Variance with which `code` is to be weighed; `noise_variance` is that of its white part. The
  // entry_index of the code in the schedule comes out, -1 if it has none (the table is full).
  double weigh(const Measurement& code, SatelliteId satellite, const CodeErrorModel& error_model,
               double noise_variance, GpsTime time, int* entry_index);
  // The filter has used the code that weigh() gave this entry_index.
  void accept(int entry_index);
  void clear() { entries_.clear(); }

 private:
  // Covariance of the constant (c) and the correlated error (b).
  struct JointCovariance {
    double cc = 0.0, cb = 0.0, bb = 0.0;
  };
  struct Entry {
    SatelliteId satellite;
    SignalCode code;
    std::uint32_t issue = 0, next_issue = 0;
    JointCovariance now, next;  // next: with the code weighed last
    GpsTime time, next_time;
  };
  int find(SatelliteId satellite, SignalCode code) const;
  int allocate_entry(GpsTime time);

  boost::container::static_vector<Entry, kMaxMeasurements> entries_;
};

}  // namespace leonav
