// This unit recognizes NMEA sentences and RTCM 3 frames between UBX messages. They are only
// counted, so that a report can distinguish them from damage.
#pragma once
#include <cstddef>
#include <cstdint>

namespace leonav {

// Counts of the messages of other protocols.
struct ForeignMessageCounters {
  std::uint64_t nmea_sentences = 0, nmea_bytes = 0;
  std::uint64_t rtcm3_frames = 0, rtcm3_bytes = 0;

  std::uint64_t bytes() const { return nmea_bytes + rtcm3_bytes; }
};

// Takes the bytes between UBX messages one by one. Only messages with a good checksum count. A byte
// that cannot continue the present message may begin another one. Nothing is searched twice, so
// each byte costs the same and a message that closely follows a false start can be missed.
class ForeignMessages {
 public:
  void take(std::uint8_t byte);
  void interrupt() { kind_ = Kind::kNone; }  // a UBX message came in between
  const ForeignMessageCounters& counters() const { return counters_; }

 private:
  enum class Kind : std::uint8_t { kNone, kNmea, kRtcm3 };

  void begin(std::uint8_t byte);
  void take_nmea(std::uint8_t byte);
  void take_rtcm3(std::uint8_t byte);

  Kind kind_ = Kind::kNone;
  std::size_t size_ = 0;               // bytes of the message so far
  std::size_t star_ = 0;               // NMEA: index of the '*', or 0
  std::size_t length_ = 0;             // RTCM 3: length of the whole frame
  std::uint32_t checksum_ = 0;         // NMEA: exclusive or; RTCM 3: remainder of the CRC
  std::uint32_t stated_checksum_ = 0;  // NMEA: the sentence's own checksum
  ForeignMessageCounters counters_;
};

}  // namespace leonav
