#include "drivers/lcm/event_header.h"

namespace leonav {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;

std::uint64_t get(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

void put(std::uint64_t value, int count, std::uint8_t* bytes) {
  for (int i = count - 1; i >= 0; --i, value >>= 8) bytes[i] = static_cast<std::uint8_t>(value);
}

}  // namespace

EventHeaderBytes encode_event_header(const EventHeader& header) {
  EventHeaderBytes bytes;
  put(kSyncWord, 4, &bytes[0]);
  put(static_cast<std::uint64_t>(header.number), 8, &bytes[4]);
  put(static_cast<std::uint64_t>(header.timestamp_us), 8, &bytes[12]);
  put(header.channel_bytes, 4, &bytes[20]);
  put(header.data_bytes, 4, &bytes[24]);
  return bytes;
}

std::optional<EventHeader> decode_event_header(const EventHeaderBytes& bytes) {
  if (!begins_event(bytes.data(), bytes.size())) return std::nullopt;
  EventHeader header;
  header.number = static_cast<std::int64_t>(get(&bytes[4], 8));
  header.timestamp_us = static_cast<std::int64_t>(get(&bytes[12], 8));
  header.channel_bytes = static_cast<std::uint32_t>(get(&bytes[20], 4));
  header.data_bytes = static_cast<std::uint32_t>(get(&bytes[24], 4));
  return header;
}

bool begins_event(const std::uint8_t* bytes, std::size_t size) {
  return size >= 4 && get(bytes, 4) == kSyncWord;
}

}  // namespace leonav
