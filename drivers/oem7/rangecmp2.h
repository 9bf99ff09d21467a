// This unit reads RANGECMP2 (1273). Source: OEM7 manual, RANGECMP2.
#pragma once
#include <span>
#include <vector>

#include "drivers/binary/range_measurement.h"

namespace leonav {

// Replaces `measurements` by those of a log's payload, all systems in its order.
RangeStatus read_rangecmp2(std::span<const std::uint8_t> payload,
                           std::vector<RangeMeasurement>* measurements);

}  // namespace leonav
