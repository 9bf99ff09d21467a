// Recognises what else a receiver sends on the port that speaks UBX: NMEA sentences and RTCM 3
// frames. They are only counted, so that a report can tell them from damage.
#pragma once
#include <cstddef>
#include <cstdint>

namespace leonav {

struct ForeignMessageCounters {
  std::uint64_t nmea_sentences = 0, nmea_bytes = 0;
  std::uint64_t rtcm3_frames = 0, rtcm3_bytes = 0;

  std::uint64_t bytes() const { return nmea_bytes + rtcm3_bytes; }
};

// Takes the bytes between UBX messages one by one. Only messages with a good checksum count. A byte
// that cannot go on what has begun may begin a message itself; nothing is searched twice, so each
// byte costs the same and a message that follows a false start closely can be missed.
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
  std::size_t size_ = 0;     // bytes of the message so far
  std::size_t star_ = 0;     // NMEA: place of the '*', or 0
  std::size_t length_ = 0;   // RTCM 3: of the whole frame
  std::uint32_t check_ = 0;  // NMEA: exclusive or; RTCM 3: remainder of the CRC
  std::uint32_t told_ = 0;   // NMEA: the sentence's own checksum
  ForeignMessageCounters counters_;
};

}  // namespace leonav
