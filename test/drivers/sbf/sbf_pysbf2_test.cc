// Every field of the blocks against pysbf2: recorded ones, and generated ones for what no recording
// has.
#include <cmath>
#include <map>

#include "core/base/angle.h"
#include "drivers/binary/accuracy_index.h"
#include "oracle_programs.h"
#include "sbf_streams.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using Words = std::vector<std::string>;

double number(const std::string& word) { return std::stod(word); }

std::vector<Words> fields_of(const std::string& path) {
  const test::TemporaryFile place("fields.txt", "");
  REQUIRE(test::run(test::sbf_oracle() + "fields '" + path + "' >'" + place.path() + "'"));
  return test::words_of(place.path());
}

std::vector<std::uint8_t> generated(int seed) {
  const test::TemporaryFile place("generated.sbf", "");
  REQUIRE(test::run(test::sbf_oracle() + "generate " + std::to_string(seed) + " >'" + place.path() +
                    "'"));
  return test::stream_bytes(place.path());
}

using SignalKey = std::tuple<GpsTime, SatelliteId, SignalCode>;

struct Agreement {
  long measurements = 0, missing = 0, different = 0;
  double range_m = 0.0, carrier_cycles = 0.0, doppler_hz = 0.0;  // largest differences
};

// The oracle prints signals of which nothing is measured too; the decoder leaves them out.
bool is_empty(const Words& line) {
  return line[5] == "nan" && line[6] == "nan" && line[7] == "nan";
}

Agreement compare_measurements(const std::vector<std::uint8_t>& bytes,
                               const std::vector<Words>& lines) {
  std::map<SignalKey, SignalObservation> ours;
  const auto decoded = test::decode_sbf(bytes);
  for (const RawEpoch& epoch : decoded.epochs) {
    for (const auto& o : epoch.observations) ours[{epoch.time, o.satellite, o.code}] = o;
  }
  CHECK(decoded.counters.epochs.bad_value == 0);
  Agreement agreement;
  long empty = 0;
  for (const Words& line : lines) {
    if (line[0] != "O") continue;
    if (is_empty(line)) {
      ++empty;
      continue;
    }
    const GpsTime time = GpsTime::from_nanoseconds(std::stoll(line[1]) * kNanosecondsPerWeek +
                                                   std::stoll(line[2]) * 1'000'000);
    ++agreement.measurements;
    CAPTURE(line[3], line[4]);
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
    if (!test::same_bits(o.cn0_dbhz, number(line[8]))) ++agreement.different;
    if (!test::same_bits(o.lock_time_s, number(line[9]))) ++agreement.different;
    // Ambiguity is said of carriers alone.
    const bool is_ambiguous = line[10] == "1" && line[6] != "nan";
    if (o.half_cycle_ambiguous != is_ambiguous) ++agreement.different;
  }
  CHECK(static_cast<long>(ours.size()) == agreement.measurements - agreement.missing);
  CHECK(static_cast<long>(decoded.counters.epochs.empty) == empty);
  return agreement;
}

// A carrier of 1e8 cycles has 1e-8 in double precision, and the oracle forms it in another order.
void check(const Agreement& agreement) {
  CAPTURE(agreement.measurements, agreement.range_m, agreement.carrier_cycles,
          agreement.doppler_hz);
  CHECK(agreement.missing == 0);
  CHECK(agreement.different == 0);
  CHECK(agreement.range_m < 1e-7);
  CHECK(agreement.carrier_cycles < 1e-6);
  CHECK(agreement.doppler_hz < 1e-9);
}

std::vector<double> orbit_of(const Ephemeris& e) {
  return {
      e.sqrt_a,   e.eccentricity, e.m0 / kPi,    e.delta_n / kPi, e.omega0 / kPi, e.omega_dot / kPi,
      e.i0 / kPi, e.i_dot / kPi,  e.omega / kPi, e.cuc,           e.cus,          e.crc,
      e.crs,      e.cic,          e.cis,         e.af0,           e.af1,          e.af2};
}

void check_orbit(const Words& line, std::size_t first, const Ephemeris& e) {
  const std::vector<double> ours = orbit_of(e);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    CAPTURE(line[0], line[1], i);
    CHECK(ours[i] == Approx(number(line[first + i])).epsilon(1e-15));
  }
}

}  // namespace

TEST_CASE("A recorded epoch agrees with pysbf2 in every value") {
  if (!test::have_pysbf2() || !test::have_shared_data(test::kX5Epoch)) return;
  const std::string path = test::shared_data(test::kX5Epoch);
  const Agreement agreement = compare_measurements(test::stream_bytes(path), fields_of(path));
  check(agreement);
  CHECK(agreement.measurements == 78);
}

TEST_CASE("Generated epochs agree with pysbf2, with every signal and every missing value") {
  if (!test::have_pysbf2()) return;
  for (const int seed : {1, 2, 3}) {
    const auto bytes = generated(seed);
    const test::TemporaryFile stream("some.sbf", std::string(bytes.begin(), bytes.end()));
    const Agreement agreement = compare_measurements(bytes, fields_of(stream.path()));
    check(agreement);
    CHECK(agreement.measurements > 700);
    std::map<std::string, long> codes;
    for (const RawEpoch& epoch : test::decode_sbf(bytes).epochs) {
      for (const auto& o : epoch.observations) {
        ++codes[to_string(o.satellite).substr(0, 1) + to_string(o.code)];
      }
    }
    // All 17 signals, one of them by two names.
    CHECK(codes.size() == 18);
    CHECK(codes["C7D"] > 5);
    CHECK(codes["E6B"] > 3);
  }
}

TEST_CASE("Generated ephemerides and coefficients agree with pysbf2") {
  if (!test::have_pysbf2()) return;
  const auto bytes = generated(1);
  const test::TemporaryFile stream("some.sbf", std::string(bytes.begin(), bytes.end()));
  const auto ours = test::decode_sbf(bytes);
  std::size_t next = 0, next_model = 0;
  for (const Words& line : fields_of(stream.path())) {
    const auto field = [&line](std::size_t i) { return number(line.at(i)); };
    if (line[0] == "GPSIon") {
      const KlobucharModel& model = ours.models.at(next_model++);
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(model.alpha[i] == field(1 + i));
        CHECK(model.beta[i] == field(5 + i));
      }
    }
    if (!line[0].ends_with("Nav")) continue;
    const Ephemeris& e = ours.ephemerides.at(next++);
    CAPTURE(line[0], line[1]);
    check_orbit(line, line[0] == "GALNav" ? 6 : 8, e);
    CHECK(e.transmission_time == test::time_at(test::kTime_ms));
    if (line[0] == "GPSNav") {
      CHECK(e.message == NavigationMessage::kGpsLnav);
      CHECK(e.satellite == SatelliteId{System::kGps, static_cast<std::uint16_t>(field(1))});
      CHECK(e.accuracy_m == nominal_accuracy_m(static_cast<unsigned>(field(2))));
      CHECK(e.health == field(3));
      CHECK(e.issue_clock == field(4));
      CHECK(e.issue == field(5));
      CHECK(e.toe.tow_s() == field(6));
      CHECK(e.toc.tow_s() == field(7));
      CHECK(e.group_delay_s[0] == field(26));
    } else if (line[0] == "BDSNav") {
      const auto satellite = static_cast<int>(field(1));
      CHECK(e.satellite.system == System::kBeidou);
      CHECK(e.satellite.number == (satellite <= 180 ? satellite - 140 : satellite - 182));
      CHECK(e.message == (is_beidou_geostationary(e.satellite) ? NavigationMessage::kBeidouD2
                                                               : NavigationMessage::kBeidouD1));
      CHECK(e.accuracy_m == nominal_accuracy_m(static_cast<unsigned>(field(2))));
      CHECK(e.health == field(3));
      CHECK(e.issue_clock == field(4));
      CHECK(e.issue == field(5));
      CHECK(e.toe.tow_s() == field(6) + 14.0);
      CHECK(e.toc.tow_s() == field(7) + 14.0);
      CHECK(e.group_delay_s[0] == field(26));
      CHECK(e.group_delay_s[1] == (field(27) == -2e10 ? 0.0 : field(27)));
    } else {
      const bool is_inav = field(2) == 2.0;
      CHECK(e.satellite ==
            SatelliteId{System::kGalileo, static_cast<std::uint16_t>(field(1) - 70)});
      CHECK(e.message ==
            (is_inav ? NavigationMessage::kGalileoInav : NavigationMessage::kGalileoFnav));
      CHECK(e.issue == field(3));
      CHECK(e.toe.tow_s() == field(4));
      CHECK(e.toc.tow_s() == field(5));
      CHECK(e.group_delay_s[0] == field(24));
      CHECK(e.group_delay_s[1] == (is_inav ? field(25) : 0.0));
      // 107 is 3.12 m; 255 is no prediction.
      CHECK(e.accuracy_m == (field(is_inav ? 27 : 26) == 255.0 ? -1.0 : 3.12));
      const auto bits = [&field](std::size_t first) {
        return field(first) == 0.0
                   ? 0
                   : static_cast<int>(field(first + 1)) | static_cast<int>(field(first + 2)) << 1;
      };
      CHECK(e.health == (is_inav ? bits(28) | bits(31) << 6 : bits(34) << 3));
    }
  }
  CHECK(next == 900);
  CHECK(next == ours.ephemerides.size());
  CHECK(next_model == 300);
}

}  // namespace leonav
