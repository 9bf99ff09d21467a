// The event log being written: one sequence per channel, increasing stamps, no half-written file.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "tools/dataset/import_report.h"

namespace leonav {

// Throws EventLogError if `path`, or the file it is written to first, is no regular file (to be put
// in the place of a device or a folder would destroy it) or is one of `inputs`.
void check_output(const std::string& path, const std::vector<std::string>& inputs);

// Counts what it writes in `report`. Each write throws EventLogError when the disk does not take
// it.
class LogOutput {
 public:
  // Writes to `path` with ".part" appended; throws EventLogError if that cannot be created.
  LogOutput(const std::string& path, ImportReport* report);
  ~LogOutput();  // removes the part file unless commit() was called

  void write(GpsTime arrival, const ImuSample& sample);
  void write(GpsTime arrival, const OdometerIncrement& increment);
  void write(GpsTime arrival, const RawEpoch& epoch);
  void write(GpsTime arrival, const Ephemeris& ephemeris);
  void write(GpsTime arrival, const KlobucharModel& model);
  void write(GpsTime arrival, std::span<const PreciseState> states);
  void write(GpsTime arrival, const AntennaPattern& pattern);

  // The file is complete: gives it its name. Where that fails nothing is left behind.
  void commit();

 private:
  void put(GpsTime arrival, Channel channel, ByteSpan bytes);
  std::uint64_t next_sequence(Channel channel) { return ++sequences_[index_of(channel)]; }
  void extend_span(GpsTime time);

  void remove_part();

  std::string path_, part_path_;
  ImportReport* report_;
  std::optional<EventLogWriter> writer_;
  Encoder encoder_;
  std::array<std::uint64_t, kChannelCount> sequences_{};
  std::array<std::string, kChannelCount> names_;
  std::int64_t last_stamp_us_ = 0;
  std::set<SatelliteId> satellites_;
};

}  // namespace leonav
