// This unit reads the code biases of satellites in Bias-SINEX files. Source: SINEX_BIAS 1.00 (IGS
// Bias and Calibration Working Group 2018).
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/gnss/propagation/signal_bias_store.h"

namespace leonav {

// The biases of a file and counts of what was left out.
struct BiasSinexFile {
  struct Problem {
    long line = 0;
    std::string what;
  };
  // Codes' biases against the clocks of the product, each with its validity, to be subtracted from
  // the measurement; sorted by satellite, code and time. `time` is unset.
  std::vector<SignalBias> biases;
  std::uint64_t differences = 0;  // DSBs that biases were made of

  std::uint64_t stations = 0;         // records of receivers
  std::uint64_t phases = 0;           // records of carriers
  std::uint64_t other_system = 0;     // of satellites that leonav does not use
  std::uint64_t other_kind = 0;       // ISB and kinds of other versions
  std::uint64_t slopes = 0;           // biases that change within their validity
  std::uint64_t beside_absolute = 0;  // DSBs of a satellite that has OSBs too
  std::uint64_t beyond_capacity =
      0;  // records after kMaxRecords, or kMaxDifferences of a satellite
  std::uint64_t without_reference = 0;  // signals that no DSBs connect to the clock's reference
  std::set<std::pair<System, SignalCode>> unconnected;  // their names
  std::uint64_t damaged_lines = 0;
  std::vector<Problem> problems;  // the first 20 of them
  bool truncated = false;         // no %=ENDBIA

  static constexpr std::size_t kMaxRecords = 500'000;
  static constexpr std::size_t kMaxDifferences = 2'000;  // of one satellite
};

// Reads OSB and DSB records. Differences are turned to biases against the pair that the file names
// as its clocks' (SATELLITE_CLOCK_REFERENCE_OBSERVABLES), else against usual_references(). Throws
// FileError if the file cannot be read, does not begin like a Bias-SINEX file of version 1.00, is
// in an unknown time system, or holds no code bias of a satellite that leonav uses.
BiasSinexFile read_bias_sinex(const std::string& path);

}  // namespace leonav
