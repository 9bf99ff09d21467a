// This unit makes biases of signals of the group delays in the modernized messages of GPS and
// BeiDou, which give those of the signals that the older messages leave out. Sources: IS-GPS-200N
// 30.3.3.3.1.1, IS-GPS-705J 20.3.3.3.1.1; BDS-SIS-ICD-B1C 1.0, 7.6; BDS-SIS-ICD-B2a 1.0, 7.6.
#pragma once
#include <optional>
#include <vector>

#include "core/gnss/propagation/signal_bias_store.h"

namespace leonav {

// What CNAV and CNAV-2 of GPS give, in seconds; without a value: not available.
struct GpsCnavDelays {
  std::optional<double> tgd;
  std::optional<double> isc_l1_ca, isc_l2c, isc_l5_i, isc_l5_q;
};

// What B-CNAV1 and B-CNAV2 of BeiDou give, in seconds; without a value: not in the message.
struct BeidouCnavDelays {
  std::optional<double> b1c_pilot, b1c_data_minus_pilot;
  std::optional<double> b2a_pilot, b2a_data_minus_pilot;
};

// Each appends to `biases` what the delays give, as kBroadcastCode with the time `received`. The
// values are metres by which a signal leaves later than that of the clock, as GroupDelay has them:
//   GPS: L1 P(Y) TGD, L2 P(Y) (77/60)^2 TGD; C/A, L2C, L5 I and Q: TGD minus the signal's ISC.
//   BeiDou, against B3I: pilots of B1C and B2a: their TGD; data: TGD plus ISC.
// Receivers that track data and pilot together get the mean by power: B1C one part of data to three
// of pilot, L5 and B2a one to one. A delay that is not available is left out with what depends on
// it.
void append_biases(const GpsCnavDelays& delays, SatelliteId satellite, GpsTime received,
                   std::vector<SignalBias>* biases);
void append_biases(const BeidouCnavDelays& delays, SatelliteId satellite, GpsTime received,
                   std::vector<SignalBias>* biases);

}  // namespace leonav
