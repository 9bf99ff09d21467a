// This unit reads MeasEpoch (4027), all measurements of an epoch. Source: mosaic-X5 Reference
// Guide, MeasEpoch.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/binary/range_measurement.h"

namespace leonav {

// What became of one block.
enum class MeasEpochStatus : std::uint8_t {
  kOk = 0,
  kBadLength,  // does not hold what it claims
  kScrambled,  // the receiver has made the measurements unusable, for want of a permission
};

// Replaces `measurements` by those of the block's payload, all systems in its order.
//
// A satellite has one master signal and slaves, which are given relative to it:
//   P_slave = P_master + offset,  D_slave = D_master f_slave / f_master + offset,
// and every carrier relative to the code of its own signal: L = P / wavelength + offset. A carrier
// without a code, or a slave's Doppler without its master's, is therefore not measured. Lock times
// are whole seconds, cut off. Signals of other antennas than the main one are left
// out and counted in `other_antennas`.
MeasEpochStatus read_meas_epoch(std::span<const std::uint8_t> payload,
                                std::vector<RangeMeasurement>* measurements,
                                std::uint64_t* other_antennas);

}  // namespace leonav
