// ColoredCodeWeighting weighs successive codes of one satellite whose errors are white noise plus a
// Gauss-Markov process.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// The filter has no state for the Gauss-Markov part (orbit, clock and atmosphere errors). Instead
// each code gets the weight that it adds to the codes of its satellite before. For every satellite
// and signal a filter of two states, an unknown constant and the process, gives the variance P_n of
// the constant after n codes. The n-th code enters the large filter with the information
//   1/P_n - 1/P_(n-1).
// The first one counts in full, the next ones until noise is averaged down to the correlated part,
// and later ones as far as that part changes; the sum is that of the best linear estimate. The
// constant stands for the position along the line of sight, so that this holds only while carriers,
// or a fixed antenna, keep the position from epoch to epoch. The method is our own.
class ColoredCodeWeighting {
 public:
  struct CodeErrorModel {
    std::uint32_t orbit_issue = 0;  // another issue has another error
    double random_walk = 0.0;       // m/sqrt(s), of the constant
    double disturbance_m = 0;       // 1 sigma of a step in it since the last epoch
    double correlation_time_s = 0;  // of the process
  };

  // Returns the variance with which `code` is to be weighed, m^2; `noise_variance` is that of its
  // white part. `entry_index` receives the code's index for accept(), -1 if the table is full.
  double weigh(const Measurement& code, SatelliteId satellite, const CodeErrorModel& error_model,
               double noise_variance, GpsTime time, int* entry_index);
  // Records that the filter has used the code to which weigh() gave this index.
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
