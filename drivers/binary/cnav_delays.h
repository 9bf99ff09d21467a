// This unit reads the bits of the group delays in the modernized messages of GPS and BeiDou.
// Sources: IS-GPS-200N 30.3.3.3.1.1 and figure 30-3 (CNAV on L2C), IS-GPS-705J 20.3.3.3.1.1 (the
// same on L5); BDS-SIS-ICD-B1C 1.0, 7.6 and figure 6-6 (B-CNAV1, subframe 2);
// BDS-SIS-ICD-B2a 1.0, 7.6 and figure 6-5 (B-CNAV2, message type 30).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/binary/cnav_biases.h"

namespace leonav {

// What a message is.
enum class CnavStatus : std::uint8_t {
  kDelays = 0,      // it has delays
  kOtherType,       // whole, but of a type without them
  kBadChecksum,     // checksum or fixed bits wrong
  kWrongSatellite,  // it names another satellite
};

// Each reads one message of `satellite`, its bits in order from the first byte's highest one, and
// appends to `biases` what it gives (cnav_biases.h).

// A CNAV message has 300 bits (38 bytes).
CnavStatus read_gps_cnav_delays(std::span<const std::uint8_t> bits, SatelliteId satellite,
                                GpsTime received, std::vector<SignalBias>* biases);
// Subframe 2 of B-CNAV1 has 600 bits (75 bytes); it names no satellite.
CnavStatus read_bcnav1_delays(std::span<const std::uint8_t> bits, SatelliteId satellite,
                              GpsTime received, std::vector<SignalBias>* biases);
// A B-CNAV2 message has 288 bits (36 bytes).
CnavStatus read_bcnav2_delays(std::span<const std::uint8_t> bits, SatelliteId satellite,
                              GpsTime received, std::vector<SignalBias>* biases);

}  // namespace leonav
