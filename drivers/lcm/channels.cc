#include "drivers/lcm/channels.h"

namespace leonav {
namespace {

constexpr std::array<std::string_view, kChannelCount> kNames = {
    "IMU", "GNSS_EPOCH", "EPHEMERIS", "ORBIT_CLOCK", "IONOSPHERE", "ANTENNA", "CORRECTED_STATES",
    "BIASES", "COMMAND", "ODOMETER", "CHECKPOINT",
    // outputs
    "SOLUTION", "EPOCH", "CONSTRAINTS", "EVENT", "DECISION", "SMOOTHER", "SMOOTHED", "HEALTH",
    // in journals only
    "CONFIG", "END", "PIECE", "REFUSED", "LOST",
    // in no journal
    "COMMAND_NONCE"};

}  // namespace

std::string_view name_of(Channel channel) { return kNames[index_of(channel)]; }

std::string channel_name(Channel channel, std::string_view prefix) {
  std::string name(prefix);
  name += name_of(channel);
  return name;
}

std::optional<Channel> channel_from_name(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Channel>(i);
  }
  return std::nullopt;
}

}  // namespace leonav
