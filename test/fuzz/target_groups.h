// The targets by concept, from which fuzz_targets() makes one table.
#pragma once
#include <vector>

#include "test/fuzz/fuzz_target.h"

namespace leonav::test {

std::vector<FuzzTarget> wire_targets();       // bytes of receivers and sensors, by StreamFormat
std::vector<FuzzTarget> file_targets();       // products, recordings and tables
std::vector<FuzzTarget> message_targets();    // LCM messages
std::vector<FuzzTarget> log_targets();        // event logs and journals
std::vector<FuzzTarget> config_targets();     // what a user or an earlier run has written
std::vector<FuzzTarget> caster_targets();     // what an NTRIP caster answers
std::vector<FuzzTarget> sequencer_targets();  // scripts of inputs

}  // namespace leonav::test
