// ImportReport counts what an import used and what it left out, and lists what the recording lacks.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"
#include "drivers/epoch/epoch_capacity.h"

namespace leonav {

// Counts, skipped items and warnings of one import.
struct ImportReport {
  struct Skip {
    std::string where;  // FILE or FILE:LINE of the first case
    std::string reason;
    long count = 0;
  };

  long epochs = 0, imu_samples = 0, ephemerides = 0, orbit_epochs = 0, clock_epochs = 0,
       ionosphere_models = 0;
  long odometer_increments = 0;
  long corrected_states = 0;  // satellites in messages of corrected states
  long signal_biases = 0;     // signals in messages of biases
  long satellite_antennas = 0;
  std::string receiver_antenna;       // name of the antenna whose model is used; empty: none
  std::map<System, long> satellites;  // different ones observed
  GpsTime first, last;                // of epochs and IMU samples
  std::vector<Skip> skipped;
  std::vector<std::string> notes;     // what was decided
  std::vector<std::string> warnings;  // missing data, with the consequence for the solution

  // Counts `count` skipped items.
  void skip(std::string_view where, std::string_view reason, long count);
  // Counts the signals that did not fit into their epochs.
  void skip(std::string_view where, const CapacityLosses& losses);
  // Warns if more than half of a stream was lost: then it differs from the recording too much.
  void warn_if_most_lost(const std::string& path, const std::string& what, long lost, long all);
};

using SkipReasons = std::vector<std::pair<const char*, std::uint64_t>>;
// Counts the skipped items of one file by their reasons.
void skip_all(const std::string& path, const SkipReasons& reasons, ImportReport* report);

// Returns an instant as a date and a time of day in GPS time.
std::string text_of(GpsTime time);
// Returns the report as text of several lines.
std::string to_string(const ImportReport& report);

}  // namespace leonav
