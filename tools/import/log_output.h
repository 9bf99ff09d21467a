// LogOutput writes the event log: one sequence per channel, increasing stamps, no incomplete file.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/input_messages.h"
#include "tools/import/import_report.h"

namespace leonav {

// Throws EventLogError if `path`, or the part file written first, is not a regular file or is one
// of `inputs`. Replacing a device or a folder would destroy it.
void check_output(const std::string& path, const std::vector<std::string>& inputs);

// LogOutput counts what it writes in `report`. Each write throws EventLogError if the disk refuses
// it.
class LogOutput {
 public:
  // Writes to `path` with ".part" appended; throws EventLogError if that file cannot be created.
  LogOutput(const std::string& path, ImportReport* report);
  ~LogOutput();  // removes the part file unless commit() was called

  void write(GpsTime arrival, const ImuSample& sample);
  void write(GpsTime arrival, const OdometerIncrement& increment);
  void write(GpsTime arrival, const RawEpoch& epoch);
  void write(GpsTime arrival, const Ephemeris& ephemeris);
  void write(GpsTime arrival, const KlobucharModel& model);
  void write(GpsTime arrival, std::span<const PreciseState> states);
  // Writes nothing where there are none.
  void write(GpsTime arrival, std::span<const CorrectedState> states,
             const CorrectionSource& source);
  void write(GpsTime arrival, std::span<const SignalBias> biases);
  void write(GpsTime arrival, const AntennaPattern& pattern);

  // Renames the complete file to its final name. If that fails, no file is left.
  void commit();

 private:
  void put(GpsTime arrival, const InputMessage& message);
  void extend_span(GpsTime time);

  void remove_part();

  std::string path_, part_path_;
  ImportReport* report_;
  std::optional<EventLogWriter> writer_;
  InputMessages messages_;
  std::array<std::string, kChannelCount> names_;
  std::int64_t last_stamp_us_ = 0;
  std::set<SatelliteId> satellites_;
};

}  // namespace leonav
