#include "daemon/journal/internal/event_buffer.h"

#include "drivers/lcm/event_header.h"

namespace leonav {

bool EventBuffer::append(std::int64_t number, std::int64_t timestamp_us, std::string_view channel,
                         std::span<const std::uint8_t> data) {
  const EventHeader header{number, timestamp_us, static_cast<std::uint32_t>(channel.size()),
                           static_cast<std::uint32_t>(data.size())};
  if (!has_room(header.event_bytes())) return false;
  const EventHeaderBytes encoded = encode_event_header(header);
  bytes_.insert(bytes_.end(), encoded.begin(), encoded.end());
  bytes_.insert(bytes_.end(), channel.begin(), channel.end());
  bytes_.insert(bytes_.end(), data.begin(), data.end());
  ++events_;
  return true;
}

}  // namespace leonav
