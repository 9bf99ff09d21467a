// ANTEX antenna files.
#pragma once
#include <span>
#include <string>

#include "core/gnss/antenna_model.h"

namespace leonav::sim {

// Source: ANTEX 1.4. One antenna for each satellite, whose patterns stand one after the other, and
// one for the receiver (name: type and radome, 20 characters). Offsets and variations in 0.01 mm;
// of variations by azimuth the mean alone. Pattern validity is not written: always. Throws
// FileError.
void write_antex(const std::string& path, std::span<const AntennaPattern> patterns,
                 const std::string& receiver_name);

}  // namespace leonav::sim
