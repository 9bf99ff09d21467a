// Group delays of CNAV and B-CNAV against an independent program, on the recorded walk.
#include "drivers/binary/cnav_delays.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "drivers/binary/bit_field.h"
#include "drivers/binary/crc24q.h"
#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using Delays = std::map<std::pair<std::string, std::string>, double>;

const GpsTime kTime = GpsTime::from_week_and_tow(2381, 403'000.0);
constexpr SatelliteId kG24{System::kGps, 24};
constexpr std::int32_t kNotAvailable = -4096;

// A CNAV message as figure 30-3 of IS-GPS-200 lays it out.
std::array<std::uint8_t, 40> cnav_message(std::uint32_t preamble, std::uint32_t prn,
                                          std::uint32_t type, std::array<std::int32_t, 5> delays) {
  BitWriter<40> writer;
  writer.put(preamble, 8);
  writer.put(prn, 6);
  writer.put(type, 6);
  for (int i = 0; i < 107; ++i) writer.put(i % 3 == 0, 1);
  for (const std::int32_t delay : delays) writer.put(static_cast<std::uint32_t>(delay), 13);
  while (writer.position() < 276) writer.put(1, 1);
  BitWriter<40> whole = writer;
  whole.put(crc24q(BitReader(writer.bytes()), 276), 24);
  return whole.bytes();
}

double delay_of(const std::vector<SignalBias>& biases, const char* code) {
  for (const SignalBias& bias : biases) {
    if (to_string(bias.code) == code) return bias.bias_m;
  }
  return NAN;
}

}  // namespace

TEST_CASE("Group delays of the walk's CNAV and B-CNAV agree with an independent reading") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const test::TemporaryFile output("cnav.txt", "");
  REQUIRE(std::system(("python3 '" LEONAV_SOURCE_DIR "/test/oracle/cnav.py' '" +
                       test::shared_data(test::kWalkUbx) + "' >'" + output.path() + "'")
                          .c_str()) == 0);
  Delays expected;
  std::ifstream file(output.path());
  std::size_t messages = 0;
  for (std::string line; std::getline(file, line); ++messages) {
    std::istringstream words(line);
    std::string satellite, code;
    words >> satellite;
    for (double metres = 0.0; words >> code >> metres;) expected[{satellite, code}] = metres;
  }
  CHECK(messages == 44 + 51 + 18);

  const auto walk = test::decode_walk();
  Delays ours;
  for (const SignalBias& bias : walk.biases) {
    CHECK(bias.kind == BiasKind::kBroadcastCode);
    CHECK(is_sane(bias));
    ours[{to_string(bias.satellite), to_string(bias.code)}] = bias.bias_m;
  }
  REQUIRE(ours.size() == expected.size());
  for (const auto& [key, metres] : expected) {
    CAPTURE(key.first, key.second);
    REQUIRE(ours.count(key) == 1);
    CHECK(ours.at(key) == Approx(metres).epsilon(1e-14).margin(1e-14));
  }
  // They change rarely: each set is reported once, though the satellites repeat it.
  CHECK(walk.counters.sfrbx.delays < 40);
}

// A broadcast TGD of LNAV has eight bits of 2^-31 s, that of CNAV thirteen of 2^-35: both come from
// one estimate. BeiDou's B1I and B1C are 14 MHz apart.
TEST_CASE("CNAV's delays are near those of the older messages of the same satellites") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const auto walk = test::decode_walk();
  int gps = 0, beidou = 0;
  for (const Ephemeris& e : walk.ephemerides) {
    if (is_for_corrections_alone(e)) continue;
    const bool is_gps = e.satellite.system == System::kGps;
    for (const SignalBias& bias : walk.biases) {
      if (bias.satellite != e.satellite || to_string(bias.code) != (is_gps ? "1W" : "1P")) continue;
      const double older_m = kSpeedOfLight * e.group_delay_s[0];
      CAPTURE(to_string(e.satellite), older_m, bias.bias_m);
      CHECK(std::abs(bias.bias_m - older_m) < (is_gps ? 0.15 : 2.0));
      ++(is_gps ? gps : beidou);
    }
  }
  CHECK(gps >= 4);
  CHECK(beidou >= 7);
}

TEST_CASE("A CNAV message gives what it has, and nothing where it is not whole") {
  std::vector<SignalBias> biases;
  const auto read = [&](const std::array<std::uint8_t, 40>& bits) {
    biases.clear();
    return read_gps_cnav_delays(bits, kG24, kTime, &biases);
  };
  const double unit = kSpeedOfLight * std::ldexp(1.0, -35);
  REQUIRE(read(cnav_message(139, 24, 30, {-4095, 4095, 0, -1, 7})) == CnavStatus::kDelays);
  CHECK(delay_of(biases, "1W") == Approx(-4095 * unit));
  CHECK(delay_of(biases, "1C") == Approx(-8190 * unit));
  CHECK(delay_of(biases, "2L") == Approx(-4095 * unit));
  CHECK(delay_of(biases, "5I") == Approx(-4094 * unit));
  CHECK(delay_of(biases, "5X") == Approx(-4098 * unit));
  CHECK(biases.front().time == kTime);

  REQUIRE(read(cnav_message(139, 24, 30, {80, 1, kNotAvailable, 51, kNotAvailable})) ==
          CnavStatus::kDelays);
  CHECK(delay_of(biases, "1C") == Approx(79 * unit));
  CHECK(delay_of(biases, "5I") == Approx(29 * unit));
  for (const char* code : {"2L", "2S", "5Q", "5X"}) CHECK(std::isnan(delay_of(biases, code)));
  REQUIRE(read(cnav_message(139, 24, 30, {kNotAvailable, 1, 2, 3, 4})) == CnavStatus::kDelays);
  CHECK(biases.empty());

  CHECK(read(cnav_message(139, 24, 10, {1, 1, 1, 1, 1})) == CnavStatus::kOtherType);
  CHECK(read(cnav_message(139, 25, 30, {1, 1, 1, 1, 1})) == CnavStatus::kWrongSatellite);
  CHECK(read(cnav_message(138, 24, 30, {1, 1, 1, 1, 1})) == CnavStatus::kBadChecksum);
  const auto good = cnav_message(139, 24, 30, {1, 1, 1, 1, 1});
  for (std::size_t bit = 0; bit < 300; ++bit) {
    auto damaged = good;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(0x80u >> bit % 8);
    CHECK(read(damaged) == CnavStatus::kBadChecksum);
    CHECK(biases.empty());
  }
  const std::array<std::uint8_t, 75> zeros{};
  CHECK(read_gps_cnav_delays(zeros, kG24, kTime, &biases) == CnavStatus::kBadChecksum);
  CHECK(read_bcnav1_delays(zeros, kG24, kTime, &biases) == CnavStatus::kBadChecksum);
  CHECK(read_bcnav2_delays(zeros, kG24, kTime, &biases) == CnavStatus::kWrongSatellite);
  for (std::size_t size = 0; size < 37; ++size) {
    biases.clear();
    CHECK(read_gps_cnav_delays(std::span(good).first(size), kG24, kTime, &biases) ==
          CnavStatus::kBadChecksum);
    CHECK(read_bcnav1_delays(std::span(good).first(size), kG24, kTime, &biases) ==
          CnavStatus::kBadChecksum);
    CHECK(biases.empty());
  }
}

}  // namespace leonav
