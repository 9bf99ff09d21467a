// This unit parses one record of the block BIAS/SOLUTION. Source: SINEX_BIAS 1.00 (IGS Bias and
// Calibration Working Group 2018), section "BIAS/SOLUTION".
#pragma once
#include <string>
#include <string_view>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// The code bias of a satellite's signal (OSB), or the difference of two, first minus second (DSB).
struct BiasRecord {
  SatelliteId satellite;
  SignalCode first;
  SignalCode second;     // unset: an OSB
  GpsTime from, until;   // unset `from`: since ever; without an end `until` is kNoEnd
  double value_s = 0.0;  // to be subtracted from the measured code
  long line = 0;         // of the file
};

// The end of a validity without end.
extern const GpsTime kNoEnd;

// What a line of the block is.
enum class BiasLine {
  kRecord,       // a code bias of a satellite that leonav uses
  kOtherSystem,  // of a satellite of another system
  kStation,      // of a receiver
  kPhase,        // of a carrier
  kOtherKind,    // ISB, or an older kind of record
  kSlope,        // a bias that changes linearly
  kDamaged,      // unreadable; the reason says why
};

// Parses a line that is no comment. Times are in `time_system`, a name of drivers/text. `why` gets
// what is wrong with a damaged line.
BiasLine parse_bias_record(std::string_view line, std::string_view time_system, BiasRecord* record,
                           std::string* why);

}  // namespace leonav
