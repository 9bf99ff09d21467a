// The inertial sensor of a u-blox receiver in an import.
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>

#include "import_outcome.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/import/import.h"
#include "tools/import/ubx_samples.h"

namespace leonav {
namespace {

using Catch::Contains;
using test::import_error;

constexpr int kWeek = 2209;

EsfReading reading_at(std::int64_t clock_ns, std::int64_t sent_ns) {
  EsfReading reading;
  reading.clock_ns = clock_ns;
  reading.sent_ns = sent_ns;
  reading.specific_force_m_s2 = {0.0, 0.0, -9.8};
  return reading;
}

std::string message(std::uint8_t message_class, std::uint8_t id, const std::string& payload) {
  std::string body = {static_cast<char>(message_class), static_cast<char>(id),
                      static_cast<char>(payload.size() & 255),
                      static_cast<char>(payload.size() >> 8)};
  body += payload;
  std::uint8_t a = 0, b = 0;
  for (const char byte : body) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(byte));
    b = static_cast<std::uint8_t>(b + a);
  }
  return "\xB5\x62" + body + static_cast<char>(a) + static_cast<char>(b);
}

void put(std::string* text, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) text->push_back(static_cast<char>(value >> (8 * i)));
}

std::string rawx(double tow_s) {
  std::string payload;
  put(&payload, std::bit_cast<std::uint64_t>(tow_s), 8);
  put(&payload, kWeek, 2);
  put(&payload, 18, 1);  // leap seconds
  put(&payload, 0, 1);   // signals
  put(&payload, 0, 1);
  put(&payload, 1, 1);  // version
  put(&payload, 0, 2);
  return message(0x02, 0x15, payload);
}

std::string raw(std::uint32_t tick) {
  std::string payload(4, '\0');
  for (const int type : {14, 13, 5, 16, 17, 18}) {
    put(&payload, static_cast<std::uint64_t>(type) << 24 | 100, 4);
    put(&payload, tick, 4);
  }
  return message(0x10, 0x03, payload);
}

// 100 Hz, and an epoch each second that is written 55 ms after its time.
std::string stream(int seconds, bool with_epochs) {
  std::string bytes;
  for (int k = 0; k < 100 * seconds; ++k) {
    bytes += raw(static_cast<std::uint32_t>(256 * k) & 0xFFFFFF);
    if (with_epochs && k % 100 == 5) bytes += rawx(1000.0 + k / 100);
  }
  return bytes;
}

}  // namespace

TEST_CASE("Samples of a file are tied to GPS time by the order of messages", "[import]") {
  // Messages of ten samples by a clock that is 100 ppm fast, sent with the last one; an epoch is
  // written 50 ms after its time, anywhere between two messages.
  const GpsTime start = GpsTime::from_week_and_tow(kWeek, 1000.0);
  const auto clock_at = [](double seconds) {
    return static_cast<std::int64_t>(seconds * (1.0 + 100e-6) * 1e9) + 5'000'000'000;
  };
  double worst_of_all_s = 0.0;
  for (const double phase_s : {0.001, 0.03, 0.051, 0.07, 0.099}) {
    UbxSamples samples(0.05);
    double worst_s = 0.0;
    long stamped = 0;
    for (int tenth = 1; tenth < 1200; ++tenth) {
      const double sent_s = 0.1 * tenth + phase_s;
      const double epoch_s = std::floor(sent_s - 0.05);
      if (epoch_s > std::floor(sent_s - 0.1 - 0.05)) samples.on_epoch(start.plus_seconds(epoch_s));
      for (int i = 9; i >= 0; --i) {
        const double time_s = sent_s - 0.01 * i;
        const auto sample = samples.take(reading_at(clock_at(time_s), clock_at(sent_s)));
        if (!sample || tenth < 300) continue;
        ++stamped;
        worst_s = std::max(worst_s, std::abs(seconds_between(sample->time, start) - time_s));
      }
    }
    CAPTURE(phase_s);
    CHECK(stamped == 9000);
    CHECK(samples.contradictions() == 0);
    CHECK(samples.uncertainty_s() == Approx(0.05).epsilon(0.01));
    CHECK(worst_s <= samples.uncertainty_s() + 0.0005);
    worst_of_all_s = std::max(worst_of_all_s, worst_s);
  }
  CHECK(worst_of_all_s > 0.04);  // the order says no more
}

TEST_CASE("A u-blox file under imu gives inertial samples and says how well they are tied",
          "[import]") {
  const test::TemporaryFile yaml("set.yaml", "imu: a.ubx\nobservations: a.ubx\n");
  std::ofstream(yaml.beside("a.ubx"), std::ios::binary) << stream(30, true);
  const ImportReport report =
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  CHECK(report.imu_samples > 2000);
  CHECK(report.epochs == 30);
  bool is_told = false;
  for (const std::string& warning : report.warnings) {
    is_told = is_told || warning.find("within 5 ms or so") != std::string::npos;
  }
  CHECK(is_told);
  std::ofstream(yaml.beside("a.ubx"), std::ios::binary) << stream(30, false);
  CHECK_THAT(import_error(yaml.path()), Contains("a.ubx") && Contains("UBX-RXM-RAWX"));
  std::ofstream(yaml.beside("a.ubx"), std::ios::binary) << rawx(1.0);
  CHECK_THAT(import_error(yaml.path()), Contains("switch UBX-ESF-RAW on"));
}

}  // namespace leonav
