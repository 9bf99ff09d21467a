// Every measurement, ephemeris and station message against pyrtcm, field by field.
#include <cmath>
#include <map>
#include <tuple>

#include "drivers/rtcm3/broadcast_ephemeris.h"
#include "drivers/rtcm3/msm_message.h"
#include "drivers/rtcm3/msm_observations.h"
#include "drivers/rtcm3/msm_signal.h"
#include "generated_messages.h"
#include "oracle_programs.h"
#include "rtcm3_streams.h"
#include "support/catch.h"
#include "support/recorded/ephemeris_elements.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using Words = std::vector<std::string>;

std::vector<Words> oracle_lines(const std::string& path) {
  const test::TemporaryFile place("fields.txt", "");
  REQUIRE(test::run(test::oracle_command() + "fields '" + path + "' >'" + place.path() + "'"));
  return test::words_of(place.path());
}

double number(const std::string& word) { return std::stod(word); }

bool is_out_of_range(std::size_t column, double value) {
  if (column == 6) return value < 1e6 || value > 1e8;  // m
  return column == 8 && std::abs(value) > 1e5;         // Hz
}

// Each message by itself, so that what epochs leave out (repeated signals) is compared too.
std::vector<Words> msm_lines(const std::vector<std::uint8_t>& bytes, GpsTime time) {
  std::vector<Words> lines;
  MsmObservations observations;
  MsmMessage message;
  std::vector<SignalObservation> signals;
  for (const auto& extent : test::frame_extents(bytes)) {
    const auto type = msm_type(extent.type);
    if (!type || !type->system || !type->has_full_range()) continue;
    time = time.plus_seconds(1.0);  // a new one each time, so that nothing counts as repeated
    signals.clear();
    REQUIRE(read_msm(*type, std::span(bytes).subspan(extent.first + 3, extent.size - 6),
                     &message) == MsmStatus::kOk);
    observations.add(message, time, &signals);
    std::size_t next = 0;
    for (const MsmCell& cell : message.cells) {
      const auto code = signal_from_msm(*type->system, cell.signal);
      REQUIRE(code);
      const SatelliteId satellite{*type->system, message.satellites[cell.satellite].number};
      SignalObservation o;
      if (next < signals.size() && signals[next].satellite == satellite &&
          signals[next].code == *code) {
        o = signals[next++];
      }
      const auto text = [](double value) {
        char buffer[40];
        std::snprintf(buffer, sizeof buffer, "%.17g", value);
        return std::string(buffer);
      };
      lines.push_back({"O", std::to_string(extent.type), std::to_string(message.header.epoch_ms),
                       message.header.more_follow ? "1" : "0", to_string(satellite),
                       to_string(*code), text(o.pseudorange_m), text(o.carrier_cycles),
                       text(o.doppler_hz), text(o.cn0_dbhz), std::to_string(cell.least_lock_ms),
                       cell.half_cycle_ambiguous ? "1" : "0"});
    }
    CHECK(next == signals.size());
  }
  return lines;
}

// With the whole numbers in front.
std::vector<double> contents_of(const Ephemeris& e) {
  std::vector<double> contents = {static_cast<double>(e.issue), static_cast<double>(e.issue_clock),
                                  static_cast<double>(e.health)};
  for (const double element : test::elements_of(e)) contents.push_back(element);
  return contents;
}

double time_of_week(const Ephemeris& e, GpsTime time) {
  return e.satellite.system == System::kBeidou ? time.plus_seconds(-14.0).tow_s() : time.tow_s();
}

// Returns how many measurements were compared.
std::size_t compare_measurements(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::vector<Words> theirs;
  for (Words& line : oracle_lines(path)) {
    if (line[0] == "O") theirs.push_back(std::move(line));
  }
  const auto ours = msm_lines(bytes, test::day(2012, 1, 1));
  REQUIRE(theirs.size() == ours.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const Words &a = ours[i], &b = theirs[i];
    REQUIRE(a.size() == b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      const bool is_value = k >= 6 && k <= 9;
      const bool same = is_value ? test::same_number(number(a[k]), number(b[k])) : a[k] == b[k];
      const bool is_left_out = a[6] == "nan" && a[7] == "nan" && a[8] == "nan";
      if (k == 9 && is_left_out) continue;  // a strength alone is no measurement
      // A generated range may be one that no receiver can measure, which is left out.
      if (same || (is_value && a[k] == "nan" && is_out_of_range(k, number(b[k])))) continue;
      if (different++ < 5) FAIL_CHECK("line " << i << ": " << a[k] << " " << b[k]);
    }
  }
  CHECK(different == 0);
  return ours.size();
}

}  // namespace

TEST_CASE("Every measurement agrees with pyrtcm to the last bit") {
  if (!test::have_pyrtcm()) return;
  const std::map<std::string, std::size_t> recordings = {
      {test::kGmsd7, 13390}, {test::kManyTypes, 200}, {test::kMixed, 38}};
  for (const auto& [name, count] : recordings) {
    if (!test::have_shared_data(name)) continue;
    CAPTURE(name);
    const std::string path = test::shared_data(name);
    CHECK(compare_measurements(path, test::stream_bytes(path)) == count);
  }
}

TEST_CASE("Generated measurements of MSM4 to MSM7 agree with pyrtcm to the last bit") {
  if (!test::have_pyrtcm()) return;
  const auto bytes = test::generated_msm(20);
  const test::TemporaryFile stream("msm.rtcm3", std::string(bytes.begin(), bytes.end()));
  CHECK(compare_measurements(stream.path(), bytes) == 3290);
}

TEST_CASE("Every ephemeris agrees with pyrtcm to the last bit") {
  if (!test::have_pyrtcm()) return;
  struct Recording {
    const char* name;
    GpsTime reference;
    std::size_t count;
  };
  for (const Recording& r : {Recording{test::kGmsd7, test::day(2012, 10, 14), 15},
                             Recording{test::kManyTypes, test::day(2024, 3, 20), 4},
                             Recording{test::kSsrHour, test::day(2023, 8, 17), 3407 + 2672}}) {
    if (!test::have_shared_data(r.name)) continue;
    const auto bytes = test::stream_bytes(test::shared_data(r.name));
    std::vector<Words> theirs;
    for (Words& line : oracle_lines(test::shared_data(r.name))) {
      if (line[0] == "E") theirs.push_back(std::move(line));
    }
    CAPTURE(r.name);
    CHECK(theirs.size() == r.count);
    std::size_t next = 0, different = 0;
    for (const auto& extent : test::frame_extents(bytes)) {
      if (!is_broadcast_ephemeris(extent.type)) continue;
      REQUIRE(next < theirs.size());
      const Words& line = theirs[next++];
      Ephemeris e;
      GpsTime stated_toe;
      // GMSD7 and the list of many types tell weeks of their own days.
      const auto status =
          decode_ephemeris(extent.type, std::span(bytes).subspan(extent.first + 3, extent.size - 6),
                           r.reference, &e, &stated_toe);
      REQUIRE(status == EphemerisStatus::kOk);
      CHECK(std::to_string(extent.type) == line[1]);
      CHECK(to_string(e.satellite) == line[2]);
      CHECK(time_of_week(e, e.toe) == number(line[4]));
      CHECK(time_of_week(e, e.toc) == number(line[5]));
      const auto elements = contents_of(e);
      REQUIRE(elements.size() + 6 == line.size());
      for (std::size_t k = 0; k < elements.size(); ++k) {
        const double theirs_k = number(line[k + 6]);
        // BeiDou's group delays are decimal there, tenths of nanoseconds here: twice rounded.
        const bool is_decimal = e.satellite.system == System::kBeidou && k >= 21;
        const bool same =
            is_decimal ? std::abs(elements[k] - theirs_k) < 1e-20 : elements[k] == theirs_k;
        if (!same && different++ < 5)
          FAIL_CHECK(line[2] << " field " << k << ": " << elements[k] << " " << theirs_k);
      }
    }
    CHECK(next == theirs.size());
    CHECK(different == 0);
  }
}

TEST_CASE("Position and equipment of a station agree with pyrtcm") {
  if (!test::have_pyrtcm() || !test::have_shared_data(test::kManyTypes)) return;
  const auto ours = test::decode_rtcm3(test::stream_bytes(test::shared_data(test::kManyTypes)),
                                       test::day(2024, 3, 20));
  std::size_t positions = 0, equipment = 0;
  for (const Words& line : oracle_lines(test::shared_data(test::kManyTypes))) {
    if (line[0] == "P") {
      REQUIRE(positions < ours.positions.size());
      const StationPosition& p = ours.positions[positions++];
      CHECK(p.station == number(line[2]));
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(p.p_e[axis] == number(line[static_cast<std::size_t>(axis) + 3]));
      }
      CHECK(p.antenna_height_m.has_value() == (line[6] != "nan"));
      if (p.antenna_height_m) CHECK(*p.antenna_height_m == number(line[6]));
    } else if (line[0] == "Q") {
      ++equipment;
      std::string theirs = line[3];
      for (std::size_t k = 4; k < line.size(); ++k) theirs += " " + line[k];
      std::string all;
      for (const auto& each : ours.equipment) {
        if (each.receiver.empty()) continue;
        for (const auto* text : {&each.antenna, &each.antenna_serial, &each.receiver,
                                 &each.firmware, &each.receiver_serial}) {
          std::string once;
          // The list is in words: runs of blanks are one there.
          for (const char c : *text) {
            if (c != ' ' || once.back() != ' ') once += c;
          }
          all += (all.empty() ? "" : "|") + once;
        }
      }
      CHECK(all == theirs);
    }
  }
  CHECK(positions == 2);
  CHECK(positions == ours.positions.size());
  CHECK(equipment == 1);
}

}  // namespace leonav
