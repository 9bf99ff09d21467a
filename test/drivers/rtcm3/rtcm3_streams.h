// Streams of RTCM 3 for all tests: recorded bytes, decoding in chunks, frames made anew.
#pragma once
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/calendar.h"
#include "drivers/binary/crc24q.h"
#include "drivers/rtcm3/rtcm3_decoder.h"
#include "support/recorded/shared_data.h"

namespace leonav::test {

// GPS and BeiDou with the other systems, four minutes, from the time before MSM was final: BeiDou's
// times of week are those of GPS.
inline constexpr const char* kGmsd7 = "wire/rtklib_GMSD7_20121014.rtcm3";
// Of 35 types one message each, of a receiver with all systems.
inline constexpr const char* kManyTypes = "wire/rtcm_NTRIP-USCL00CHL0.bin";
inline constexpr const char* kMixed = "wire/rtcm_MIXED-RTCM3.bin";
inline constexpr const char* kOldForm = "wire/rtklib_testglo.rtcm3";
inline constexpr const char* kSsrHour = "wire/ssr_idd2023229c.rtc";

inline GpsTime day(int year, int month, int day_of_month) {
  return from_calendar({year, month, day_of_month, 12, 0, 0.0});
}
inline const GpsTime kDay = day(2012, 10, 14);  // of kGmsd7

inline constexpr std::size_t kMoreFollow = 54;  // bit of DF393

struct Rtcm3Collector : Rtcm3Handler {
  void on_epoch(const RawEpoch& epoch) override { epochs.push_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { ephemerides.push_back(ephemeris); }
  void on_station_position(const StationPosition& position) override {
    positions.push_back(position);
  }
  void on_station_equipment(const StationEquipment& each) override { equipment.push_back(each); }

  std::vector<RawEpoch> epochs;
  std::vector<Ephemeris> ephemerides;
  std::vector<StationPosition> positions;
  std::vector<StationEquipment> equipment;
  Rtcm3Counters counters;
};

inline std::vector<std::uint8_t> stream_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline Rtcm3Collector decode_rtcm3(std::span<const std::uint8_t> bytes, GpsTime reference,
                                   std::size_t chunk = 4096) {
  Rtcm3Collector collector;
  Rtcm3Decoder decoder({reference});
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(chunk, bytes.size()))) {
    decoder.feed(bytes.first(std::min(chunk, bytes.size())), &collector);
  }
  decoder.finish(&collector);
  collector.counters = decoder.counters();
  return collector;
}

// The frames of a clean stream, each with its first byte and number.
struct FrameExtent {
  std::size_t first = 0, size = 0;
  std::uint16_t type = 0;
};
inline std::vector<FrameExtent> frame_extents(const std::vector<std::uint8_t>& bytes) {
  std::vector<FrameExtent> found;
  for (std::size_t i = 0; i + 6 <= bytes.size();) {
    const std::size_t size = 6u + 256u * (bytes[i + 1] & 3u) + bytes[i + 2];
    if (bytes[i] != 0xD3 || (bytes[i + 1] & 0xFC) != 0 || i + size > bytes.size()) {
      ++i;
      continue;
    }
    found.push_back(
        {i, size, static_cast<std::uint16_t>((bytes[i + 3] << 4) | (bytes[i + 4] >> 4))});
    i += size;
  }
  return found;
}

// Puts preamble, length and checksum around a message.
inline std::vector<std::uint8_t> framed(std::span<const std::uint8_t> message) {
  std::vector<std::uint8_t> frame;
  frame.reserve(message.size() + 6);
  frame.push_back(0xD3);
  frame.push_back(static_cast<std::uint8_t>(message.size() >> 8));
  frame.push_back(static_cast<std::uint8_t>(message.size() & 0xFF));
  for (const std::uint8_t byte : message) frame.push_back(byte);
  const std::uint32_t crc = crc24q(BitReader(frame), static_cast<int>(frame.size() * 8));
  for (const int shift : {16, 8, 0}) frame.push_back(static_cast<std::uint8_t>(crc >> shift));
  return frame;
}

// A recorded frame with some bits of its message set to other values.
struct BitEdit {
  std::size_t position = 0;  // from the first bit of the message
  int count = 0;
  std::uint32_t value = 0;
};
inline std::vector<std::uint8_t> edited(std::span<const std::uint8_t> frame,
                                        const std::vector<BitEdit>& edits) {
  std::vector<std::uint8_t> message(frame.begin() + 3, frame.end() - 3);
  for (const BitEdit& edit : edits) {
    for (int i = 0; i < edit.count; ++i) {
      const std::size_t bit = edit.position + static_cast<std::size_t>(i);
      const auto mask = static_cast<std::uint8_t>(0x80u >> (bit % 8));
      const bool is_set = (edit.value >> (edit.count - 1 - i)) & 1u;
      message[bit / 8] =
          static_cast<std::uint8_t>(is_set ? message[bit / 8] | mask : message[bit / 8] & ~mask);
    }
  }
  return framed(message);
}

inline void append(std::vector<std::uint8_t>* stream, const std::vector<std::uint8_t>& bytes) {
  for (const std::uint8_t byte : bytes) stream->push_back(byte);
}

inline bool same_number(double a, double b) { return a == b || (a != a && b != b); }

inline bool same_observation(const SignalObservation& a, const SignalObservation& b) {
  return a.satellite == b.satellite && a.code == b.code &&
         same_number(a.pseudorange_m, b.pseudorange_m) &&
         same_number(a.carrier_cycles, b.carrier_cycles) &&
         same_number(a.doppler_hz, b.doppler_hz) && same_number(a.cn0_dbhz, b.cn0_dbhz);
}

// Loss of lock depends on the epoch before, which may be lost: it is left out.
inline bool same_epoch(const RawEpoch& a, const RawEpoch& b) {
  return a.time == b.time &&
         std::equal(a.observations.begin(), a.observations.end(), b.observations.begin(),
                    b.observations.end(), same_observation);
}

}  // namespace leonav::test
