// This unit decodes an RTCM 3 byte stream to observations, ephemerides, corrections and what it
// says of its station. Source: RTCM 10403.3.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/signals/observation.h"
#include "drivers/binary/ephemeris_status.h"
#include "drivers/rtcm3/epoch_assembly.h"
#include "drivers/rtcm3/rtcm3_framer.h"
#include "drivers/rtcm3/ssr_reader.h"
#include "drivers/rtcm3/station_messages.h"

namespace leonav {

// The handler gets the decoder's results in the order of the stream.
class Rtcm3Handler {
 public:
  virtual ~Rtcm3Handler() = default;
  virtual void on_epoch(const RawEpoch& epoch) = 0;
  virtual void on_ephemeris(const Ephemeris& ephemeris) = 0;
  // The time of ephemeris in the week that an ephemeris message, also a repeated one, itself
  // states.
  virtual void on_stated_toe(GpsTime) {}
  virtual void on_station_position(const StationPosition&) {}
  virtual void on_station_equipment(const StationEquipment&) {}
  virtual void on_ssr(const SsrMessage&) {}
};

// Counts of ephemeris messages.
struct Rtcm3EphemerisCounters : EphemerisRefusals {
  std::uint64_t ephemerides = 0;        // given out
  std::uint64_t repeated = 0;           // same contents as the one before
  std::uint64_t without_reference = 0;  // the week is not known
  // So many messages in a row, up to the last one, are of another week than the time that was told.
  std::uint64_t other_week_in_row = 0;
};

// Counts of SSR messages of the systems that are used.
struct Rtcm3SsrCounters {
  std::uint64_t messages = 0;  // given out
  std::uint64_t bad_length = 0;
  std::uint64_t bad_time = 0;           // time beyond the end of the week
  std::uint64_t without_reference = 0;  // the week is not known
  SsrLeftOut left_out;
};

// Counts of all parts of the decoder.
struct Rtcm3Counters {
  Rtcm3FramerCounters framer;
  EpochAssemblyCounters epochs;
  MsmMeasurementCounters measurements;
  Rtcm3EphemerisCounters ephemerides;
  Rtcm3SsrCounters ssr;
  std::uint64_t station_messages = 0;
  std::uint64_t damaged_station_messages = 0;     // shorter than their fields
  std::map<std::uint16_t, std::uint64_t> unused;  // other messages, by number
  CapacityLosses losses;                          // signals that did not fit into their epoch
};

// Returns in a few words what a message is that Rtcm3Counters::unused counts.
std::string_view unused_message_text(std::uint16_t message_number);

// Returns whether such messages hold the ephemerides of a system that is not used.
bool is_ephemeris_of_unused_system(std::uint16_t message_number);

// Settings of the decoder.
struct Rtcm3Options {
  // An instant less than three and a half days from the beginning of the stream, whose messages
  // give times of week alone. Unset: neither observations nor ephemerides can be decoded until
  // Rtcm3Decoder::tell_time().
  GpsTime reference;
};

// The decoder streams: chunks of any size, no recursion, bounded memory. Each time is the one
// nearest to that of the epoch before, so that a stream may last as long as it will and pause for
// three days. An ephemeris is given out once per contents, however often it is repeated, and counts
// as sent when it first came: at the last epoch's time, or at the time that was told after it.
class Rtcm3Decoder {
 public:
  explicit Rtcm3Decoder(const Rtcm3Options& options = {});
  ~Rtcm3Decoder();

  // Tells the present time of a live stream, exact to some seconds.
  void tell_time(GpsTime now);
  // Tells a time within three days of the present one, which says the week and no more. The
  // transmission times of ephemerides are then unset.
  void tell_week(GpsTime near);
  // A connection has begun, at which another station may be: the next one's messages are used.
  void allow_other_station();
  void feed(std::span<const std::uint8_t> bytes, Rtcm3Handler* handler);
  // Ends the stream: decodes what a false preamble near the end holds back, and gives out an epoch
  // whose last message did not come.
  void finish(Rtcm3Handler* handler);
  Rtcm3Counters counters() const;

 private:
  void drain(Rtcm3Handler* handler);
  void dispatch(const Rtcm3Frame& frame, Rtcm3Handler* handler);
  void take_epoch(const RawEpoch& epoch, Rtcm3Handler* handler);
  void take_ephemeris(const Rtcm3Frame& frame, Rtcm3Handler* handler);
  void take_ssr(const SsrType& type, const Rtcm3Frame& frame, Rtcm3Handler* handler);
  bool take_station(const Rtcm3Frame& frame, Rtcm3Handler* handler);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
