// This unit reads RANGE (43) and RANGECMP (140). Source: OEM7 manual, RANGE and RANGECMP.
#pragma once
#include <span>
#include <vector>

#include "drivers/binary/range_measurement.h"

namespace leonav {

// Each function replaces `measurements` by those of a log's payload, all systems in its order.
RangeStatus read_range(std::span<const std::uint8_t> payload,
                       std::vector<RangeMeasurement>* measurements);

// The carrier of RANGECMP is cut to 2^23 cycles; the whole ones follow from the pseudorange, and a
// carrier without one is not measured.
RangeStatus read_rangecmp(std::span<const std::uint8_t> payload,
                          std::vector<RangeMeasurement>* measurements);

}  // namespace leonav
