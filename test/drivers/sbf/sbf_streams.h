// Streams of SBF blocks for all tests: recorded ones, decoding in chunks, and blocks packed here by
// the guide's tables.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "drivers/sbf/sbf_decoder.h"
#include "support/recorded/shared_data.h"

namespace leonav::test {

// A mosaic-X5 of 2025: one epoch (MeasEpoch, MeasExtra, EndOfMeas), one block of raw navigation
// bits of each kind, and a minute of positions.
inline constexpr const char* kX5Epoch = "wire/sbf_x5_measurements.bin";
inline constexpr const char* kX5Navigation = "wire/sbf_x5_rawnav.bin";
inline constexpr const char* kX5Positions = "wire/sbf_sbfdata.bin";
// Two blocks between NMEA sentences and RTCM 3 frames.
inline constexpr const char* kMixed = "wire/sbf_mixed.bin";

struct SbfCollector : SbfHandler {
  void on_epoch(const RawEpoch& epoch) override { epochs.push_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { ephemerides.push_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { models.push_back(model); }
  void on_imu(const ExtSensorRates& each) override { rates.push_back(each); }

  std::vector<RawEpoch> epochs;
  std::vector<Ephemeris> ephemerides;
  std::vector<KlobucharModel> models;
  std::vector<ExtSensorRates> rates;
  SbfCounters counters;
};

inline std::vector<std::uint8_t> stream_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline SbfCollector decode_sbf(std::span<const std::uint8_t> bytes, std::size_t chunk = 4096) {
  SbfCollector collector;
  SbfDecoder decoder;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(chunk, bytes.size()))) {
    decoder.feed(bytes.first(std::min(chunk, bytes.size())), &collector);
  }
  decoder.finish(&collector);
  collector.counters = decoder.counters();
  return collector;
}

inline SbfCollector decode_recorded(const char* name) {
  return decode_sbf(stream_bytes(shared_data(name)));
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

// The guide's checksum, bit by bit.
inline std::uint16_t checksum_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    for (int i = 7; i >= 0; --i) {
      const std::uint32_t carry = ((crc >> 15) ^ (byte >> i)) & 1u;
      crc = ((crc << 1) & 0xFFFF) ^ (carry ? 0x1021u : 0u);
    }
  }
  return static_cast<std::uint16_t>(crc);
}

inline constexpr int kWeek = 2367;
inline constexpr std::uint32_t kTime_ms = 482'321'000;
inline GpsTime time_at(std::uint32_t milliseconds) {
  return GpsTime::from_nanoseconds(kWeek * kNanosecondsPerWeek +
                                   std::int64_t{milliseconds} * 1'000'000);
}

struct BlockHeader {
  std::uint16_t number = 0;
  std::uint32_t milliseconds = kTime_ms;
  std::uint16_t week = kWeek;
  std::uint16_t revision = 0;
};
inline std::vector<std::uint8_t> block_of(const BlockHeader& header,
                                          std::span<const std::uint8_t> payload) {
  const std::size_t size = (14 + payload.size() + 3) / 4 * 4;
  Bytes covered;
  covered.u2(header.number | (header.revision << 13)).u2(size).u4(header.milliseconds);
  covered.u2(header.week).join(payload);
  while (covered.list.size() < size - 4) covered.u1(0x5A);
  Bytes bytes;
  return bytes.u1('$').u1('@').u2(checksum_of(covered.list)).join(covered.list).list;
}

// A slave signal and a master signal of MeasEpoch, by default with every value.
struct Slave {
  unsigned type = 2, lock_s = 254, cn0 = 140;
  int code_high = 0, doppler_high = 0, carrier_high = 0;
  unsigned info = 0, code_low = 500, carrier_low = 1000, doppler_low = 100;
};
struct Master {
  unsigned type = 0, satellite = 5;
  std::uint64_t code_mm = 21'761'200'335;
  std::int64_t doppler = 11'217'580;
  unsigned carrier_low = 7, carrier_high = 0, cn0 = 160, lock_s = 876, info = 0;
  std::vector<Slave> slaves = {};
};
inline std::vector<std::uint8_t> meas_epoch_of(const std::vector<Master>& masters,
                                               unsigned flags = 0) {
  Bytes bytes;
  bytes.u1(masters.size()).u1(20).u1(12).u1(flags).u1(0).u1(0);
  for (const Master& m : masters) {
    bytes.u1(9).u1(m.type).u1(m.satellite).u1(m.code_mm >> 32).u4(m.code_mm).i4(m.doppler);
    bytes.u2(m.carrier_low).u1(m.carrier_high).u1(m.cn0).u2(m.lock_s).u1(m.info);
    bytes.u1(m.slaves.size());
    for (const Slave& s : m.slaves) {
      const unsigned high = (static_cast<unsigned>(s.code_high) & 7u) |
                            ((static_cast<unsigned>(s.doppler_high) & 31u) << 3);
      bytes.u1(s.type).u1(s.lock_s).u1(s.cn0).u1(high);
      bytes.u1(static_cast<unsigned>(s.carrier_high) & 0xFFu).u1(s.info);
      bytes.u2(s.code_low).u2(s.carrier_low).u2(s.doppler_low);
    }
  }
  return bytes.list;
}
inline std::vector<std::uint8_t> epoch_block(const std::vector<Master>& masters,
                                             std::uint32_t milliseconds = kTime_ms) {
  return block_of({4027, milliseconds}, meas_epoch_of(masters));
}

// The blocks of a clean stream, each with its first byte and size.
struct BlockExtent {
  std::size_t first = 0, size = 0;
};
inline std::vector<BlockExtent> block_extents(const std::vector<std::uint8_t>& bytes) {
  std::vector<BlockExtent> found;
  for (std::size_t i = 0; i + 8 <= bytes.size();) {
    const std::size_t size = bytes[i + 6] + 256u * bytes[i + 7];
    const bool is_sync = bytes[i] == '$' && bytes[i + 1] == '@';
    if (!is_sync || size < 14 || size % 4 != 0 || i + size > bytes.size() ||
        checksum_of(std::span(bytes).subspan(i + 4, size - 4)) !=
            bytes[i + 2] + 256u * bytes[i + 3]) {
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
