#include "tools/sim/overlay/recording_rules.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>
#include <string_view>

namespace leonav::sim {
namespace {

bool names_only_low(const Fault& fault) {
  return std::ranges::all_of(fault.systems, [](System s) { return s == System::kLeo; }) &&
         std::ranges::all_of(fault.satellites,
                             [](SatelliteId id) { return id.system == System::kLeo; });
}

// The keys that a recording replaces: a key itself, or a group with all keys below it.
constexpr std::array<std::string_view, 32> kRecorded = {"start_gps_week",
                                                        "start_gps_tow_s",
                                                        "duration_s",
                                                        "route.file",
                                                        "route.waypoints",
                                                        "route.standing_s",
                                                        "route.origin_latitude_deg",
                                                        "route.origin_longitude_deg",
                                                        "route.origin_height_m",
                                                        "route.block_m",
                                                        "route.hill_m",
                                                        "route.max_acceleration_m_s2",
                                                        "route.max_braking_m_s2",
                                                        "route.max_lateral_m_s2",
                                                        "imu",
                                                        "odometer",
                                                        "truth_interval_s",
                                                        "satellites.gps",
                                                        "satellites.galileo",
                                                        "satellites.beidou",
                                                        "receiver.interval_s",
                                                        "receiver.latency_s",
                                                        "receiver.noise.gps",
                                                        "receiver.noise.galileo",
                                                        "receiver.noise.beidou",
                                                        "receiver.clock.oscillator",
                                                        "receiver.clock.offset_us",
                                                        "receiver.clock.drift_ppb",
                                                        "receiver.clock.jumps",
                                                        "receiver.cn0.zenith_dbhz.gps",
                                                        "receiver.cn0.zenith_dbhz.galileo",
                                                        "receiver.cn0.zenith_dbhz.beidou"};

bool is_in(std::string_view key, std::string_view group) {
  return key.starts_with(group) &&
         (key.size() == group.size() || key[group.size()] == '.' || key[group.size()] == '[');
}

}  // namespace

void check_overlay_faults(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    switch (fault.kind) {
      case FaultKind::kOutage:
        if (fault.below_elevation > 0.5 * std::numbers::pi) break;
        throw std::runtime_error(fault.where +
                                 ": below_elevation_deg has no effect with --overlay, which does "
                                 "not look where the recording's satellites are; take it out");
      case FaultKind::kSatelliteClock:
      case FaultKind::kBadOrbit:
      case FaultKind::kSpoofing:
        if (names_only_low(fault)) break;
        throw std::runtime_error(fault.where +
                                 ": with --overlay only outages meet satellites of the recording; "
                                 "name low ones, or none");
      case FaultKind::kImuGap:
      case FaultKind::kImuSaturation:
      case FaultKind::kLate:
      case FaultKind::kDuplicate:
      case FaultKind::kReceiverReset:
        throw std::runtime_error(fault.where +
                                 ": has no effect with --overlay, which copies the recording's IMU "
                                 "and times of messages as they are; take it out");
    }
  }
}

std::vector<std::string> keys_of_the_recording(const std::vector<std::string>& given) {
  std::vector<std::string> found;
  for (const std::string& key : given) {
    const bool recorded = std::ranges::any_of(
        kRecorded, [&key](std::string_view group) { return is_in(key, group); });
    // A group is represented by its keys.
    const bool is_group = std::ranges::any_of(
        given, [&key](const std::string& other) { return other != key && is_in(other, key); });
    if (recorded && !is_group) found.push_back(key);
  }
  return found;
}

}  // namespace leonav::sim
