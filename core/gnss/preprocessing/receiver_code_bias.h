// This unit estimates the receiver's own delay of each band against the first band of its system.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// Differences of corrected codes, other band minus reference band, of the satellites of one epoch.
struct InterBandDifferences {
  boost::container::static_vector<double, kMaxSatellites> values_m;
  // What they contain of an error of the ionosphere's modelled zenith delay on L1, m/m.
  boost::container::static_vector<double, kMaxSatellites> ionosphere_mappings;
  double sigma_m = 1.0;  // 1 sigma of one difference by the noise model
};

// Receivers delay their bands differently: a geodetic one by metres, a phone by kilometres (L5 of
// the drive data set: 2358 m). The clock of a system absorbs these delays only if all its
// satellites are measured on the same bands. Therefore each epoch's median over the satellites with
// both bands is filtered as a slow random walk and removed from the codes. Only differences within
// a satellite enter: the position matters only through the atmosphere.
//
// The correction is noisy and drifts with the error of the ionosphere model. So where codes are
// combined in pairs, the clock is that of the reference pair, which then needs no correction at
// all, and other pairs are corrected to it.
class ReceiverCodeBiases {
 public:
  // Opens an epoch. The same `time` again (another pass over it) starts from the state before it.
  void open(GpsTime time);
  // Sets the band with which the others of `system` are compared; a change discards their delays.
  void set_reference(System system, char band);
  char reference(System system) const { return systems_[index_of(system)].reference; }
  // Sets the band that forms the reference pair with the reference band; 0: the clock is that of
  // the reference band alone. `gamma` is its factor in the ionosphere-free combination.
  void set_partner(System system, char band, double gamma);
  char partner(System system) const { return systems_[index_of(system)].partner; }
  bool is_reference_pair(System system, char first, char second) const;
  void update(System system, char band, const InterBandDifferences& differences);

  // Return the metres to subtract from the code of `band`, and the variance; both are zero where
  // nothing is known. They do not apply to the two codes of the reference pair in combination.
  double offset_m(System system, char band) const;
  double variance_m2(System system, char band) const;
  // Returns what offset_m() contains of an error of the ionosphere's modelled zenith delay on L1,
  // m/m: the delays are differences of codes, and what the model leaves differs from band to band.
  double ionosphere_mapping(System system, char band) const;
  // Follows a step of the modelled zenith delay on L1, m.
  void step_ionosphere_model(double step_m);
  // Allows for a step of all delays of a system with this variance, m^2: the next epochs decide.
  void widen(System system, double variance_m2);

 private:
  struct Bias {
    double value_m = 0.0;
    double variance_m2 = -1.0;  // negative: unknown
    int outlier_epochs = 0;
    double ionosphere_mapping = 0.0;  // filtered as value_m is
  };
  struct SystemBiases {
    char reference = 0, partner = 0;
    double partner_gamma = 0.0;
    std::array<Bias, 10> bands;  // by the digit of the band
  };
  using State = std::array<SystemBiases, kSystemCount>;
  const Bias* find(System system, char band) const;
  double delay_m(System system, char band) const;  // against the reference band

  GpsTime time_;
  State before_{};  // at the end of the previous epoch
  State systems_{};
};

}  // namespace leonav
