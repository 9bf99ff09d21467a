// Streams of NovAtel bytes for all tests: recorded ones, decoding in chunks, and messages packed
// here by the manual's tables.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "drivers/oem7/oem7_decoder.h"
#include "support/recorded/shared_data.h"

namespace leonav::test {

// An OEM-V receiver of 2009: RANGECMP, RAWEPHEM and others of GPS, GLONASS and SBAS, 46 s.
inline constexpr const char* kOemv = "wire/rtklib_oemv_200911218.gps";
// SPAN receivers of 2020: INS solutions with long and short headers, INSCONFIG.
inline constexpr const char* kIns1 = "wire/novatel_ins1.gps";
inline constexpr const char* kIns2 = "wire/novatel_ins2.gps";
// Positions with ASCII between the binary messages.
inline constexpr const char* kPositions = "wire/novatel_bestpos.gps";

struct Oem7Collector : Oem7Handler {
  void on_epoch(const RawEpoch& epoch) override { epochs.push_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { ephemerides.push_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { models.push_back(model); }
  void on_imu(const RawImuIncrements& each) override { increments.push_back(each); }

  std::vector<RawEpoch> epochs;
  std::vector<Ephemeris> ephemerides;
  std::vector<KlobucharModel> models;
  std::vector<RawImuIncrements> increments;
  Oem7Counters counters;
};

inline std::vector<std::uint8_t> stream_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline Oem7Collector decode_oem7(std::span<const std::uint8_t> bytes, std::size_t chunk = 4096,
                                 const Oem7Options& options = {}) {
  Oem7Collector collector;
  Oem7Decoder decoder(options);
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(chunk, bytes.size()))) {
    decoder.feed(bytes.first(std::min(chunk, bytes.size())), &collector);
  }
  decoder.finish(&collector);
  collector.counters = decoder.counters();
  return collector;
}

// Numbers one after the other, least significant byte first.
class Bytes {
 public:
  Bytes& u1(std::uint64_t value) { return add(value, 1); }
  Bytes& u2(std::uint64_t value) { return add(value, 2); }
  Bytes& u4(std::uint64_t value) { return add(value, 4); }
  Bytes& i4(std::int64_t value) { return add(static_cast<std::uint64_t>(value), 4); }
  Bytes& r4(float value) { return add(std::bit_cast<std::uint32_t>(value), 4); }
  Bytes& r8(double value) { return add(std::bit_cast<std::uint64_t>(value), 8); }
  Bytes& join(std::span<const std::uint8_t> more) {
    list.insert(list.end(), more.begin(), more.end());
    return *this;
  }
  std::vector<std::uint8_t> list;

 private:
  Bytes& add(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) list.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    return *this;
  }
};

// The manual's checksum, bit by bit.
inline std::uint32_t checksum_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xEDB88320u : crc >> 1;
  }
  return crc;
}

inline constexpr int kWeek = 2209;
inline constexpr std::uint32_t kTime_ms = 512'487'000;
inline GpsTime time_at(std::uint32_t milliseconds) {
  return GpsTime::from_nanoseconds(kWeek * kNanosecondsPerWeek +
                                   std::int64_t{milliseconds} * 1'000'000);
}

struct LongHeader {
  std::uint16_t id = 0;
  std::uint32_t milliseconds = kTime_ms;
  std::uint8_t type = 0, time_status = 180;
  std::uint16_t week = kWeek;
};
inline std::vector<std::uint8_t> message_of(const LongHeader& header,
                                            std::span<const std::uint8_t> payload) {
  Bytes bytes;
  bytes.u1(0xAA).u1(0x44).u1(0x12).u1(28).u2(header.id).u1(header.type).u1(0x20);
  bytes.u2(payload.size()).u2(0).u1(100).u1(header.time_status).u2(header.week);
  bytes.u4(header.milliseconds).u4(0).u2(0).u2(16809).join(payload);
  return bytes.u4(checksum_of(bytes.list)).list;
}
inline std::vector<std::uint8_t> short_message_of(std::uint16_t id, std::uint32_t milliseconds,
                                                  std::span<const std::uint8_t> payload) {
  Bytes bytes;
  bytes.u1(0xAA).u1(0x44).u1(0x13).u1(payload.size()).u2(id).u2(kWeek).u4(milliseconds);
  bytes.join(payload);
  return bytes.u4(checksum_of(bytes.list)).list;
}

// The tracking status of a channel with code, phase and parity.
inline std::uint32_t tracking(std::uint32_t system, std::uint32_t signal,
                              std::uint32_t locks = 7u << 10) {
  return 4u | locks | (system << 16) | (signal << 21);
}

// One record of RANGE.
struct RangeRecord {
  std::uint16_t number = 5;
  std::uint32_t status = tracking(0, 0);
  double range_m = 21'761'200.335, adr_cycles = -114'355'879.993;
  float doppler_hz = 1121.758F, cn0_dbhz = 50.0F, lock_s = 876.785F;
};
inline std::vector<std::uint8_t> range_of(std::span<const RangeRecord> records) {
  Bytes bytes;
  bytes.u4(records.size());
  for (const RangeRecord& r : records) {
    bytes.u2(r.number).u2(0).r8(r.range_m).r4(0.036F).r8(r.adr_cycles).r4(0.006F);
    bytes.r4(r.doppler_hz).r4(r.cn0_dbhz).r4(r.lock_s).u4(r.status);
  }
  return bytes.list;
}

// The messages of a clean stream, each with its first byte and size.
struct MessageExtent {
  std::size_t first = 0, size = 0;
};
inline std::vector<MessageExtent> message_extents(const std::vector<std::uint8_t>& bytes) {
  std::vector<MessageExtent> found;
  for (std::size_t i = 0; i + 32 <= bytes.size();) {
    const bool is_long = bytes[i + 2] == 0x12, is_short = bytes[i + 2] == 0x13;
    const std::size_t size =
        is_long ? 32u + bytes[i + 8] + 256u * bytes[i + 9] : 16u + bytes[i + 3];
    if (bytes[i] != 0xAA || bytes[i + 1] != 0x44 || (!is_long && !is_short) ||
        i + size > bytes.size() || checksum_of(std::span(bytes).subspan(i, size)) != 0) {
      ++i;
      continue;
    }
    found.push_back({i, size});
    i += size;
  }
  return found;
}

inline bool same_bits(double a, double b) { return a == b || (a != a && b != b); }

// Loss of lock depends on the epoch before, which may be lost: it is left out.
inline bool same_epoch(const RawEpoch& a, const RawEpoch& b) {
  return a.time == b.time &&
         std::equal(a.observations.begin(), a.observations.end(), b.observations.begin(),
                    b.observations.end(), [](const auto& x, const auto& y) {
                      return x.satellite == y.satellite && x.code == y.code &&
                             same_bits(x.pseudorange_m, y.pseudorange_m) &&
                             same_bits(x.carrier_cycles, y.carrier_cycles) &&
                             same_bits(x.doppler_hz, y.doppler_hz) &&
                             same_bits(x.cn0_dbhz, y.cn0_dbhz);
                    });
}

}  // namespace leonav::test
