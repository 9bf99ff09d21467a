// This unit adds simulated low satellites to a recorded run and removes recorded satellites from
// it.
#pragma once
#include <string>
#include <vector>

#include "tools/common/progress_bar.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Counts of one overlay.
struct OverlayReport {
  long messages = 0;            // of the recording; all except epochs are copied byte by byte
  long epochs = 0;              // of the recording
  long with_leo = 0;            // to which low satellites were added
  long removed = 0, added = 0;  // observations
  // Epochs whose clock could not be determined; they get no low satellites.
  long without_clock = 0;
  // Change of the receiver's clock from epoch to epoch beyond its drift.
  double clock_noise_m = 0.0;
  bool truncated = false;           // the recording ends within a message
  std::vector<std::string> unused;  // keys of the scenario that the recording replaces
};
std::string to_string(const OverlayReport& report);

// Copies `recorded` to `output` with low satellites added and others removed.
//
// Each epoch loses the satellites that the scenario's outages name. It gains those of the
// scenario's low satellites that its antenna would have received, by the recorded receiver's clock
// (recorded_clock.h); their orbits, clocks and antennas are provided too. The scenario's settings
// of other systems, of the IMU and of the receiver's clock have no effect (recording_rules.h lists
// the keys; faults of that kind are errors). The scenario's route is the truth of the recording.
OverlayReport overlay(const Scenario& scenario, const std::string& recorded,
                      const std::string& output, ProgressBar* progress);

}  // namespace leonav::sim
