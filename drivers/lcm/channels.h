// The LCM channels of leonav are enumerated here, with their names.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace leonav {

inline constexpr std::string_view kDefaultChannelPrefix = "LEONAV_";

enum class Channel : std::uint8_t {
  // inputs
  kImu,
  kGnssEpoch,
  kEphemeris,
  kOrbitClock,
  kIonosphere,
  kAntenna,
  kCommand,
  kOdometer,
  kCheckpoint,
  // outputs
  kSolution,
  kEpoch,
  kConstraints,
  kEvent,
  kDecision,
  kSmoother,
  kHealth,
  kConfig,  // in journals only: the first message
  kEnd,     // in journals only: the last message
};
inline constexpr std::size_t kChannelCount = 18;
inline constexpr std::array<Channel, 9> kInputChannels = {
    Channel::kImu,        Channel::kGnssEpoch,  Channel::kEphemeris,
    Channel::kOrbitClock, Channel::kIonosphere, Channel::kAntenna,
    Channel::kCommand,    Channel::kOdometer,   Channel::kCheckpoint};

constexpr std::size_t index_of(Channel channel) { return static_cast<std::size_t>(channel); }
constexpr bool is_input(Channel channel) { return channel <= Channel::kCheckpoint; }
// Products are repeated whatever the vehicle does: orbits, clocks, ionosphere, antennas.
constexpr bool is_product(Channel channel) {
  return channel >= Channel::kEphemeris && channel <= Channel::kAntenna;
}

std::string_view name_of(Channel channel);  // "IMU", "GNSS_EPOCH", ...

// The full name, as in "LEONAV_IMU": the configured prefix and the name.
std::string channel_name(Channel channel, std::string_view prefix = kDefaultChannelPrefix);

// nullopt for a channel that leonav does not have. Does not allocate.
std::optional<Channel> channel_from_name(std::string_view name,
                                         std::string_view prefix = kDefaultChannelPrefix);

}  // namespace leonav
