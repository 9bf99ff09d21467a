// Channel enumerates the LCM channels of leonav and gives their names.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace leonav {

inline constexpr std::string_view kDefaultChannelPrefix = "LEONAV_";

// The channels; inputs come first. refused_t holds the number of an input: append only.
enum class Channel : std::uint8_t {
  // inputs
  kImu,
  kGnssEpoch,
  kEphemeris,
  kOrbitClock,
  kIonosphere,
  kAntenna,
  kCorrectedStates,
  kBiases,
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
  kSmoothed,
  kHealth,
  // in journals only
  kConfig,   // the first message
  kEnd,      // the last message
  kPiece,    // behind the configuration: which piece of which journal this is
  kRefused,  // inputs that are counted, not held
  kLost,     // messages are missing here
  // an output that is in no journal
  kCommandNonce,
};
inline constexpr std::size_t kChannelCount = 25;
inline constexpr std::array<Channel, 11> kInputChannels = {
    Channel::kImu,        Channel::kGnssEpoch, Channel::kEphemeris,       Channel::kOrbitClock,
    Channel::kIonosphere, Channel::kAntenna,   Channel::kCorrectedStates, Channel::kBiases,
    Channel::kCommand,    Channel::kOdometer,  Channel::kCheckpoint};

constexpr std::size_t index_of(Channel channel) { return static_cast<std::size_t>(channel); }
// Returns whether leonav receives the channel.
constexpr bool is_input(Channel channel) { return channel <= Channel::kCheckpoint; }
// Returns whether a replay consumes the channel.
constexpr bool is_replayed(Channel channel) {
  return is_input(channel) || channel == Channel::kRefused;
}
// Returns whether the channel carries products: orbits, clocks, ionosphere, antennas, biases. Their
// senders repeat them regardless of the vehicle.
constexpr bool is_product(Channel channel) {
  return channel >= Channel::kEphemeris && channel <= Channel::kBiases;
}

// Returns the name without prefix, for instance "GNSS_EPOCH".
std::string_view name_of(Channel channel);

// Returns the full name, the configured prefix and the name: "LEONAV_IMU".
std::string channel_name(Channel channel, std::string_view prefix = kDefaultChannelPrefix);

// Returns the channel with this full name, or nullopt if leonav has none. Does not allocate.
std::optional<Channel> channel_from_name(std::string_view name,
                                         std::string_view prefix = kDefaultChannelPrefix);

}  // namespace leonav
