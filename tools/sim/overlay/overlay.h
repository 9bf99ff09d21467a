// Simulated low satellites over a recorded run, and recorded satellites taken away.
#pragma once
#include <string>
#include <vector>

#include "tools/common/progress_bar.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

struct OverlayReport {
  long messages = 0;            // of the recording, all but epochs copied byte by byte
  long epochs = 0;              // of it
  long with_leo = 0;            // that low satellites were added to
  long removed = 0, added = 0;  // observations
  long without_clock = 0;       // epochs whose clock could not be told, which get none
  double clock_noise_m =
      0.0;                 // change of the receiver's clock from epoch to epoch beyond its drift
  bool truncated = false;  // the recording ends within a message
  std::vector<std::string> unused;  // keys of the scenario that the recording says instead
};
std::string to_string(const OverlayReport& report);

// Copies `recorded` to `output`. Each epoch loses the satellites that outages of the scenario name
// and gains those of the scenario's low satellites that its antenna would have received, by the
// recorded receiver's clock (recorded_clock.h); their orbits, clocks and antennas are told too.
// What the scenario says of other systems, of the IMU and of the receiver's clock has no effect
// (recording_rules.h tells which keys; faults of that kind are errors).
// The scenario's route is the truth of the recording.
//
// Added messages carry the sequence number 0, which no receiver counts as a loss, and an epoch
// keeps its own. Throws std::runtime_error where nothing could be added or taken away, and
// EventLogError.
OverlayReport overlay(const Scenario& scenario, const std::string& recorded,
                      const std::string& output, ProgressBar* progress);

}  // namespace leonav::sim
