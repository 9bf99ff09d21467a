// Every field of the logs against novatel-edie: recorded ones, and generated ones for the logs that
// no recording has.
#include <cmath>
#include <map>
#include <numeric>

#include "core/base/calendar.h"
#include "drivers/oem7/imu_scale.h"
#include "oem7_streams.h"
#include "oracle_programs.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using Words = std::vector<std::string>;

double number(const std::string& word) { return std::stod(word); }

std::vector<Words> fields_of(const std::string& path) {
  const test::TemporaryFile place("fields.txt", "");
  REQUIRE(
      test::run(test::oem7_oracle() + "fields '" + path + "' >'" + place.path() + "' 2>/dev/null"));
  return test::words_of(place.path());
}

std::vector<std::uint8_t> generated(int seed) {
  const test::TemporaryFile place("generated.bin", "");
  REQUIRE(test::run(test::oem7_oracle() + "generate " + std::to_string(seed) + " >'" +
                    place.path() + "'"));
  return test::stream_bytes(place.path());
}

using Key = std::tuple<GpsTime, SatelliteId, SignalCode>;

struct Agreement {
  long measurements = 0, missing = 0, different = 0;
  double carrier_cycles = 0.0, doppler_hz = 0.0, range_m = 0.0,
         lock_s = 0.0;  // largest differences
};

Agreement compare_measurements(const std::vector<std::uint8_t>& bytes,
                               const std::vector<Words>& lines) {
  std::map<Key, SignalObservation> ours;
  for (const RawEpoch& epoch : test::decode_oem7(bytes).epochs) {
    for (const auto& o : epoch.observations) ours[{epoch.time, o.satellite, o.code}] = o;
  }
  Agreement agreement;
  for (const Words& line : lines) {
    if (line[0] != "O" || line[4] == "-") continue;
    const GpsTime time = GpsTime::from_nanoseconds(std::stoll(line[1]) * kNanosecondsPerWeek +
                                                   std::stoll(line[2]) * 1'000'000);
    ++agreement.measurements;
    const auto found =
        ours.find({time, *satellite_from_string(line[3]), *signal_from_string(line[4])});
    if (found == ours.end()) {
      ++agreement.missing;
      continue;
    }
    const SignalObservation& o = found->second;
    const auto worst = [](double* largest, double a, double b) {
      if (std::isnan(a) && std::isnan(b)) return;
      *largest = std::max(*largest, std::isnan(a - b) ? 1e9 : std::abs(a - b));
    };
    worst(&agreement.range_m, o.pseudorange_m, number(line[5]));
    worst(&agreement.carrier_cycles, o.carrier_cycles, number(line[6]));
    worst(&agreement.doppler_hz, o.doppler_hz, number(line[7]));
    worst(&agreement.lock_s, o.lock_time_s, number(line[9]));
    // C/N0 of RANGECMP4 is a multiple of 0.05, there in single precision.
    if (std::abs(o.cn0_dbhz - number(line[8])) > 1e-5) ++agreement.different;
    if (o.half_cycle_ambiguous != (line[10] == "1")) ++agreement.different;
  }
  CHECK(static_cast<long>(ours.size()) == agreement.measurements - agreement.missing);
  return agreement;
}

// The generated messages with one number.
std::vector<std::uint8_t> only(const std::vector<std::uint8_t>& bytes, std::uint16_t id) {
  std::vector<std::uint8_t> result;
  for (const auto& extent : test::message_extents(bytes)) {
    if (bytes[extent.first + 4] + 256 * bytes[extent.first + 5] != id) continue;
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(extent.first);
    result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(extent.size));
  }
  return result;
}

Agreement compare_generated(int seed, std::uint16_t id) {
  const auto bytes = only(generated(seed), id);
  const test::TemporaryFile stream("some.bin", std::string(bytes.begin(), bytes.end()));
  return compare_measurements(bytes, fields_of(stream.path()));
}

}  // namespace

TEST_CASE("Measurements of a recorded RANGECMP agree with novatel-edie to the last bit") {
  if (!test::have_edie() || !test::have_shared_data(test::kOemv)) return;
  const std::string path = test::shared_data(test::kOemv);
  const Agreement agreement = compare_measurements(test::stream_bytes(path), fields_of(path));
  CHECK(agreement.measurements == 828);
  CHECK(agreement.missing == 0);
  CHECK(agreement.different == 0);
  CHECK(agreement.range_m == 0.0);
  CHECK(agreement.carrier_cycles == 0.0);
  CHECK(agreement.doppler_hz == 0.0);
  CHECK(agreement.lock_s == 0.0);
}

TEST_CASE("Generated measurements of every range log agree with novatel-edie") {
  if (!test::have_edie()) return;
  struct Log {
    std::uint16_t id;
    double doppler_hz;   // half a unit of single precision, in which the package holds them
    bool has_lock_time;  // otherwise the package continues the lower bounds of RANGECMP4
  };
  long measurements = 0;
  for (const Log& log : {Log{43, 0.0, true}, Log{140, 0.0, true}, Log{1273, 0.00025, true},
                         Log{2050, 0.00025, false}}) {
    for (const int seed : {1, 2, 3}) {
      const Agreement agreement = compare_generated(seed, log.id);
      CAPTURE(log.id, seed, agreement.range_m, agreement.carrier_cycles, agreement.doppler_hz,
              agreement.lock_s);
      measurements += agreement.measurements;
      CHECK(agreement.measurements > 500);
      CHECK(agreement.missing == 0);
      CHECK(agreement.different == 0);
      CHECK(agreement.range_m == 0.0);
      CHECK(agreement.carrier_cycles == 0.0);
      if (log.has_lock_time) CHECK(agreement.lock_s < 1e-5);  // in single precision there
      CHECK(agreement.doppler_hz <= log.doppler_hz);
    }
  }
  CHECK(measurements == 17'600);
}

TEST_CASE("Generated ephemerides and coefficients agree with novatel-edie to the last bit") {
  if (!test::have_edie()) return;
  const auto bytes = generated(1);
  const test::TemporaryFile stream("some.bin", std::string(bytes.begin(), bytes.end()));
  const auto ours = test::decode_oem7(bytes);
  std::size_t next = 0, next_model = 0, compared = 0;
  const auto orbit_of = [](const Ephemeris& e) {
    return std::vector{e.eccentricity, e.m0,  e.delta_n, e.omega0, e.omega_dot, e.i0,  e.i_dot,
                       e.omega,        e.cuc, e.cus,     e.crc,    e.crs,       e.cic, e.cis};
  };
  const auto tow = [](GpsTime time) { return time.tow_s(); };
  const auto check = [&](const Words& line, std::size_t first, const std::vector<double>& values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      CAPTURE(line[0], line[1], first + k);
      CHECK(values[k] == number(line[first + k]));
      ++compared;
    }
  };
  for (const Words& line : fields_of(stream.path())) {
    if (line[0] == "IONUTC") {
      const KlobucharModel& model = ours.models.at(next_model++);
      check(line, 1, {model.alpha.begin(), model.alpha.end()});
      check(line, 5, {model.beta.begin(), model.beta.end()});
    } else if (line[0] == "GPSEPHEM") {
      const Ephemeris& e = ours.ephemerides.at(next++);
      CHECK(e.satellite.system == System::kGps);
      check(line, 1,
            {double(e.satellite.number), tow(e.transmission_time), double(e.health),
             double(e.issue), double(e.issue_clock), tow(e.toe), tow(e.toc)});
      CHECK(e.sqrt_a == std::sqrt(number(line[8])));
      check(line, 9, orbit_of(e));
      check(line, 23, {e.af0, e.af1, e.af2, e.group_delay_s[0]});
      CHECK(e.accuracy_m == std::sqrt(number(line[27])));
    } else if (line[0] == "BDSEPHEMERIS") {
      const Ephemeris& e = ours.ephemerides.at(next++);
      CHECK(e.satellite.system == System::kBeidou);
      check(line, 1,
            {double(e.satellite.number), double(e.health), double(e.issue), double(e.issue_clock),
             tow(e.toe) - 14.0, tow(e.toc) - 14.0, e.sqrt_a});
      check(line, 8, orbit_of(e));
      check(line, 22, {e.af0, e.af1, e.af2, e.group_delay_s[0], e.group_delay_s[1], e.accuracy_m});
    } else if (line[0] == "GALINAVEPHEMERIS" || line[0] == "GALFNAVEPHEMERIS") {
      const bool is_inav = line[0] == "GALINAVEPHEMERIS";
      const std::size_t at = is_inav ? 6 : 4;  // of the issue
      const auto bit = [&](std::size_t k) { return static_cast<int>(number(line[k])); };
      const Ephemeris& e = ours.ephemerides.at(next++);
      CHECK(e.message ==
            (is_inav ? NavigationMessage::kGalileoInav : NavigationMessage::kGalileoFnav));
      CHECK(e.satellite == SatelliteId{System::kGalileo, static_cast<std::uint16_t>(bit(1))});
      CHECK(e.health == (is_inav ? bit(5) | bit(4) << 1 | bit(3) << 6 | bit(2) << 7
                                 : bit(3) << 3 | bit(2) << 4));
      CHECK(e.accuracy_m == 3.12);  // index 107
      check(line, at, {double(e.issue), tow(e.toe), e.sqrt_a});
      check(line, at + 3, orbit_of(e));
      check(line, at + 17, {tow(e.toc), e.af0, e.af1, e.af2, 107.0, e.group_delay_s[0]});
      if (is_inav) check(line, at + 23, {e.group_delay_s[1]});
      if (!is_inav) CHECK(e.group_delay_s[1] == 0.0);
    } else if (line[0] == "GALEPHEMERIS") {
      const auto bit = [&](std::size_t k) { return static_cast<int>(number(line[k])); };
      for (const bool is_inav : {true, false}) {
        if (number(line[is_inav ? 3 : 2]) == 0.0) continue;
        const Ephemeris& e = ours.ephemerides.at(next++);
        CHECK(e.message ==
              (is_inav ? NavigationMessage::kGalileoInav : NavigationMessage::kGalileoFnav));
        CHECK(e.satellite.number == number(line[1]));
        CHECK(e.health == (is_inav ? bit(7) | bit(4) << 1 | bit(9) << 6 | bit(6) << 7
                                   : bit(8) << 3 | bit(5) << 4));
        CHECK(e.accuracy_m == 3.12);  // index 107
        check(line, 10, {double(e.issue), tow(e.toe), e.sqrt_a});
        check(line, 13, orbit_of(e));
        check(line, is_inav ? 31 : 27, {tow(e.toc), e.af0, e.af1, e.af2});
        CHECK(e.group_delay_s[0] == number(line[35]));
        CHECK(e.group_delay_s[1] == (is_inav ? number(line[36]) : 0.0));
      }
    }
  }
  CHECK(next == ours.ephemerides.size());
  CHECK(next == 1701);
  CHECK(next_model == 300);
  CHECK(compared == 42'621);
}

TEST_CASE(
    "The manual's examples of Galileo's logs, made binary by novatel-edie, give their numbers") {
  if (!test::have_edie()) return;
  const test::TemporaryFile stream("examples.bin", "");
  REQUIRE(test::run(test::oem7_oracle() + "examples >'" + stream.path() + "' 2>/dev/null"));
  const auto ours = test::decode_oem7(test::stream_bytes(stream.path()));
  CHECK(ours.counters.unused.empty());
  REQUIRE(ours.ephemerides.size() == 2);
  for (const Ephemeris& e : ours.ephemerides) {
    CHECK(e.satellite == SatelliteId{System::kGalileo, 2});
    CHECK(e.health == 0);
    CHECK(e.issue == 68);
    CHECK(e.accuracy_m == 3.12);
    CHECK(e.toe == GpsTime::from_week_and_tow(2209, 501'600.0));
    CHECK(e.toc == e.toe);
    CHECK(e.m0 == 1.94195529);
    CHECK(e.delta_n == 3.0676e-09);
    CHECK(e.eccentricity == 3.055053530e-04);
    CHECK(e.sqrt_a == 5440.60316);
    CHECK(e.i0 == 0.9740321573);
    CHECK(e.i_dot == 5.6931e-10);
    CHECK(e.omega0 == 0.6473214246);
    CHECK(e.omega == 0.3503504077);
    CHECK(e.omega_dot == -5.8141708e-09);
    CHECK(std::array{e.cuc, e.cus, e.crc, e.crs, e.cic, e.cis} ==
          std::array{7.6238e-06, 4.7404e-06, 240.9, 161.0, -5.0291e-08, 2.9802e-08});
    CHECK(e.af1 == 2.359002e-12);
    CHECK(e.af2 == 0.0);
    CHECK(e.group_delay_s[0] == -6.985e-10);
  }
  CHECK(ours.ephemerides[0].message == NavigationMessage::kGalileoInav);
  CHECK(ours.ephemerides[0].transmission_time == GpsTime::from_week_and_tow(2209, 504'514.0));
  CHECK(ours.ephemerides[0].af0 == 2.989528002e-04);
  // Word 5 of the same satellite in the manual's example of GALINAVRAWEPHEMERIS: -3 and -7 times
  // 2^-32 s.
  CHECK(ours.ephemerides[0].group_delay_s[1] == Approx(-7 * 0x1p-32).epsilon(1e-3));
  CHECK(ours.ephemerides[0].group_delay_s[0] == Approx(-3 * 0x1p-32).epsilon(1e-3));
  CHECK(ours.ephemerides[1].message == NavigationMessage::kGalileoFnav);
  CHECK(ours.ephemerides[1].af0 == 2.989536151e-04);
  CHECK(ours.ephemerides[1].group_delay_s[1] == 0.0);
}

TEST_CASE("Generated inertial samples agree with novatel-edie, turned and scaled") {
  if (!test::have_edie()) return;
  const auto bytes = generated(2);
  const test::TemporaryFile stream("some.bin", std::string(bytes.begin(), bytes.end()));
  const auto ours = test::decode_oem7(bytes);
  const ImuScale scale = *documented_imu_scale(41);
  std::size_t next = 0;
  for (const Words& line : fields_of(stream.path())) {
    if (line[0] != "RAWIMU") continue;
    const RawImuIncrements& i = ours.increments.at(next++);
    CHECK(i.time == GpsTime::from_week_and_tow(static_cast<int>(number(line[1])), number(line[2])));
    // The fields are z, -y, x: up, backward, right.
    CHECK(i.delta_velocity_m_s[0] == -number(line[4]) * scale.velocity_m_s);
    CHECK(i.delta_velocity_m_s[1] == number(line[5]) * scale.velocity_m_s);
    CHECK(i.delta_velocity_m_s[2] == -number(line[3]) * scale.velocity_m_s);
    CHECK(i.delta_theta_rad[0] == -number(line[7]) * scale.angle_rad);
    CHECK(i.delta_theta_rad[1] == number(line[8]) * scale.angle_rad);
    CHECK(i.delta_theta_rad[2] == -number(line[6]) * scale.angle_rad);
  }
  CHECK(next == 1200);
  CHECK(ours.increments.size() == 1200);
}

}  // namespace leonav
