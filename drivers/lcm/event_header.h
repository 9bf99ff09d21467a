// EventHeader is what stands before each event of an LCM event log.
//
// Format (LCM documentation, "Log file format"), big endian: sync word 0xEDA1DA01, event number
// (8 bytes), timestamp in microseconds (8), channel length (4), data length (4), channel, data.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace leonav {

inline constexpr std::size_t kEventHeaderBytes = 28;
inline constexpr std::uint32_t kMaxEventChannelBytes = 999;  // liblcm has the same limit
// Messages of liblcm have at most some megabytes.
inline constexpr std::uint32_t kMaxEventDataBytes = 64U << 20;

using EventHeaderBytes = std::array<std::uint8_t, kEventHeaderBytes>;

struct EventHeader {
  std::int64_t number = 0;
  std::int64_t timestamp_us = 0;
  std::uint32_t channel_bytes = 0, data_bytes = 0;

  // Of the whole event.
  std::size_t event_bytes() const { return kEventHeaderBytes + channel_bytes + data_bytes; }
  // Returns whether the lengths are within the limits.
  bool is_sane() const {
    return channel_bytes > 0 && channel_bytes <= kMaxEventChannelBytes &&
           data_bytes <= kMaxEventDataBytes;
  }
};

EventHeaderBytes encode_event_header(const EventHeader& header);

// Returns nullopt where the bytes do not begin with the sync word.
std::optional<EventHeader> decode_event_header(const EventHeaderBytes& bytes);

// Returns whether bytes begin with the sync word.
bool begins_event(const std::uint8_t* bytes, std::size_t size);

}  // namespace leonav
