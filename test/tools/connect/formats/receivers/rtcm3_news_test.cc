// What leonav-connect tells of an RTCM 3 stream once: a station that moves, and messages that are
// not used. Messages are encoded here by the standard's tables.
#include <cmath>
#include <string>
#include <vector>

#include "drivers/binary/bit_field.h"
#include "drivers/binary/crc24q.h"
#include "support/catch.h"
#include "tools/connect/formats/receivers/rtcm3_format.h"

namespace leonav {
namespace {

struct Unheard : MessageTarget {
  void take(Channel, ByteSpan) override {}
};

std::vector<std::uint8_t> rtcm_frame(const BitWriter<64>& bits) {
  const std::size_t size = (bits.position() + 7) / 8;
  std::vector<std::uint8_t> bytes = {0xD3, 0, static_cast<std::uint8_t>(size)};
  bytes.insert(bytes.end(), bits.bytes().begin(), bits.bytes().begin() + std::ptrdiff_t(size));
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : bytes) crc = crc24q_next(crc, byte);
  for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(crc >> shift));
  return bytes;
}

// 1006 of a station that far from a place in Europe.
std::vector<std::uint8_t> station_at(std::uint32_t station, double x_m, bool is_known = true) {
  BitWriter<64> bits;
  const auto put = [&bits](double metres) {
    const auto value = static_cast<std::uint64_t>(std::llround(metres * 1e4));
    bits.put(static_cast<std::uint32_t>(value >> 32) & 0x3FU, 6);
    bits.put(static_cast<std::uint32_t>(value), 32);
  };
  bits.put(1006, 12);
  bits.put(station, 12);
  bits.put(0, 10);
  put(is_known ? 3'800'000.0 + x_m : 0.0);
  bits.put(0, 2);
  put(is_known ? -652'000.0 : 0.0);
  bits.put(0, 2);
  put(is_known ? 5'060'000.0 : 0.0);
  bits.put(0, 16);
  return rtcm_frame(bits);
}

std::vector<std::uint8_t> message_of(std::uint32_t number) {
  BitWriter<64> bits;
  bits.put(number, 12);
  bits.put(1, 12);
  bits.put(0, 24);
  return rtcm_frame(bits);
}

struct NewsRig {
  void feed(const std::vector<std::uint8_t>& bytes) {
    format.feed(bytes, 1'700'000'000'000'000'000);
  }
  // Of warnings, or of the others.
  std::string news(bool of_warnings) {
    std::string all;
    for (const FormatNews& news : format.take_news()) {
      if (news.is_warning == of_warnings) all += news.text;
    }
    return all;
  }
  Unheard target;
  MessageOutput output{&target};
  GpsClock clock{TimeReference::kGnss, 0.05};
  Rtcm3Format format{GpsTime(), 30.0, &clock, &output};
};

}  // namespace

TEST_CASE("A station that moves by more than a metre is told once, and counted", "[connect]") {
  NewsRig rig;
  rig.feed(station_at(12, 0.0, false));  // it does not know where it is yet
  rig.feed(station_at(12, 0.0));
  rig.feed(station_at(12, 0.9));    // surveyed better
  rig.feed(station_at(13, 700.0));  // another one beside it
  rig.feed(station_at(12, 0.0));
  CHECK(rig.format.take_news().empty());
  CHECK(rig.format.detail().empty());
  rig.feed(station_at(12, 812.5));
  CHECK_THAT(rig.news(true), Catch::Contains("station 12 has moved by 812.5 m"));
  CHECK(rig.format.detail() == "its station 12 has moved 1 times, the last by 812.5 m");
  rig.feed(station_at(12, 0.0));
  CHECK(rig.format.take_news().empty());
  CHECK(rig.format.detail() == "its station 12 has moved 2 times, the last by 812.5 m");
}

TEST_CASE("Each message that is not used is named once", "[connect]") {
  NewsRig rig;
  for (const std::uint32_t number : {1230U, 1013U, 1230U, 1005U}) rig.feed(message_of(number));
  CHECK(rig.news(false) ==
        "not used: 1013 system parameters, 1230 GLONASS code and phase biases (system not used)");
  rig.feed(message_of(1230));
  CHECK(rig.format.take_news().empty());
  rig.feed(message_of(1020));
  CHECK(rig.news(false) == "not used: 1020 GLONASS ephemeris (system not used)");
}

TEST_CASE("Noise with the numbers of many messages is told in short lines, and not for ever",
          "[connect]") {
  NewsRig rig;
  for (std::uint32_t number = 2000; number < 2200; ++number) rig.feed(message_of(number));
  std::string all;
  for (int second = 0; second < 100; ++second) {
    const std::string line = rig.news(false);
    CHECK(line.size() < 200);
    all += line + "\n";
  }
  CHECK_THAT(all, Catch::Contains("2000 ") && Catch::Contains("2039 ") &&
                      !Catch::Contains("2040") && Catch::Contains("others"));
  rig.feed(message_of(2200));
  CHECK(rig.format.take_news().empty());
}

TEST_CASE("Where the station of a service is does not matter", "[connect]") {
  Unheard target;
  MessageOutput output(&target);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format service(GpsTime(), 30.0, &clock, &output, true);
  for (const double x_m : {0.0, 812.5}) {
    service.feed(station_at(12, x_m), 1'700'000'000'000'000'000);
  }
  CHECK(service.take_news().empty());
  CHECK(service.detail().empty());
}

}  // namespace leonav
