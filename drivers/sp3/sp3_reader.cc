#include "drivers/sp3/sp3_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "core/base/calendar.h"
#include "drivers/text/line_reader.h"
#include "drivers/text/time_system.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxProblems = 20;
constexpr double kBadClock = 999'999.0;       // microseconds; the format writes 999999.999999
constexpr double kMaxCoordinate = 100'000.0;  // km: twice beyond any orbit in use

// The reader takes one file; its members hold the contents of the lines read so far.
class Reader {
 public:
  explicit Reader(const std::string& path) : lines_(path) {}

  Sp3File read() {
    read_first_line();
    std::string_view line;
    while (!ended_ && lines_.next(line)) read_line(line);
    file_.truncated = !ended_;
    drop_empty_epochs();
    if (file_.states == 0) {
      throw FileError(lines_.path(), 0,
                      "holds no position of a satellite that leonav uses; check that it is a "
                      "complete SP3-c or SP3-d file");
    }
    return std::move(file_);
  }

 private:
  void read_first_line() {
    std::string_view line;
    if (!lines_.next(line)) throw FileError(lines_.path(), 0, "is empty; expected an SP3 file");
    if (line.size() < 3 || line[0] != '#' || (line[1] != 'c' && line[1] != 'd')) {
      lines_.fail(
          "does not begin with '#c' or '#d'; only SP3 versions c and d are read, convert others");
    }
    file_.version = line[1];
    file_.frame = trim(columns(line, 46, 5));
    // A file that names no time system is in GPS time.
    file_.time_system = "GPS";
  }

  void read_line(std::string_view line) {
    if (line.empty()) return;
    if (line.starts_with("EOF")) {
      ended_ = true;
    } else if (line[0] == '*') {
      read_epoch(line);
    } else if (line[0] == 'P') {
      read_position(line);
    } else if (line.starts_with("+ ")) {
      read_satellite_count(line);
    } else if (line.starts_with("%c")) {
      read_time_system(line);
    }
    // Velocities (V), correlations (EP, EV), accuracies (++), comments and the rest: not used.
  }

  // The first "+" line gives the number of satellites; SP3-d has as many lines as it takes.
  void read_satellite_count(std::string_view line) {
    if (file_.satellites_listed != 0) return;
    const std::optional<int> count = parse_int(columns(line, 3, 3));
    if (!count || *count < 1 || *count > 999) return damaged("number of satellites is unreadable");
    file_.satellites_listed = *count;
  }

  // The first "%c" line gives the time system.
  void read_time_system(std::string_view line) {
    if (time_system_known_) return;
    time_system_known_ = true;
    const std::string_view name = trim(columns(line, 9, 3));
    if (name == "ccc" || name.empty()) return;
    if (!is_known_time_system(name)) {
      lines_.fail("time system '" + std::string(name) +
                  "' is not known; use a file in GPS, GAL, BDT, QZS, TAI or UTC time");
    }
    file_.time_system = name;
  }

  void read_epoch(std::string_view line) {
    epoch_is_good_ = false;
    const auto year = parse_int(columns(line, 3, 4)), month = parse_int(columns(line, 8, 2)),
               day = parse_int(columns(line, 11, 2)), hour = parse_int(columns(line, 14, 2)),
               minute = parse_int(columns(line, 17, 2));
    const auto second = parse_double(columns(line, 20, 11));
    if (!year || !month || !day || !hour || !minute || !second || *year < 1980 || *year > 2199 ||
        *month < 1 || *month > 12 || *day < 1 || *day > 31 || *hour < 0 || *hour > 23 ||
        *minute < 0 || *minute > 59 || *second < 0.0 || *second >= 61.0) {
      return damaged("epoch is unreadable; its positions are left out");
    }
    const GpsTime time = gps_time_of(from_calendar({*year, *month, *day, *hour, *minute, *second}),
                                     file_.time_system);
    if (!file_.epochs.empty() && time <= file_.epochs.back().time) {
      return damaged("epoch is not later than the one before; its positions are left out");
    }
    epoch_is_good_ = true;
    file_.epochs.push_back({time, {}});
  }

  void read_position(std::string_view line) {
    if (!epoch_is_good_) {
      if (file_.epochs.empty()) damaged("position before the first epoch");
      return;  // the damaged epoch is already counted
    }
    const std::string_view name = columns(line, 1, 3);
    const std::optional<SatelliteId> satellite = satellite_from_string(name);
    if (!satellite) {
      if (is_other_system(name)) {
        ++file_.other_system;
      } else {
        damaged("satellite name is unreadable");
      }
      return;
    }
    PreciseState state{*satellite, file_.epochs.back().time, {}, 0.0};
    for (int axis = 0; axis < 3; ++axis) {
      const auto kilometres = parse_double(columns(line, 4 + 14 * axis, 14));
      if (!kilometres || std::abs(*kilometres) > kMaxCoordinate) {
        return damaged("coordinate is unreadable or out of range");
      }
      state.p_e[axis] = *kilometres * 1e3;
    }
    if (state.p_e.isZero(0.0)) {
      ++file_.bad_positions;
      return;
    }
    read_clock(line, &state);
    read_flags(line, &state);
    file_.epochs.back().states.push_back(state);
  }

  void read_clock(std::string_view line, PreciseState* state) {
    const std::string_view text = columns(line, 46, 14);
    const std::optional<double> microseconds = parse_double(text);
    if (microseconds && std::abs(*microseconds) < kBadClock) {
      state->clock_s = *microseconds * 1e-6;
      return;
    }
    state->clock_s = std::numeric_limits<double>::quiet_NaN();
    ++file_.bad_clocks;
    if (!microseconds && !trim(text).empty()) damaged("clock is unreadable; the position is kept");
  }

  // The flags are in columns 75, 76, 79 and 80 (both versions): clock event, predicted clock,
  // maneuver, predicted orbit.
  void read_flags(std::string_view line, PreciseState* state) {
    const auto is = [&](std::size_t column, char letter) {
      return line.size() > column && line[column] == letter;
    };
    state->clock_event = is(74, 'E');
    state->clock_predicted = is(75, 'P');
    state->maneuver = is(78, 'M');
    state->orbit_predicted = is(79, 'P');
    file_.clock_events += state->clock_event ? 1 : 0;
    file_.maneuvers += state->maneuver ? 1 : 0;
    file_.predicted += state->clock_predicted || state->orbit_predicted ? 1 : 0;
  }

  static bool is_other_system(std::string_view name) {
    return name.size() == 3 && name[0] >= 'A' && name[0] <= 'Z' &&
           parse_int(name.substr(1)).has_value();
  }

  void damaged(const std::string& what) {
    ++file_.damaged_lines;
    if (file_.problems.size() < kMaxProblems) {
      file_.problems.push_back({lines_.line_number(), what});
    }
  }

  void drop_empty_epochs() {
    std::erase_if(file_.epochs, [](const Sp3Epoch& epoch) { return epoch.states.empty(); });
    for (Sp3Epoch& epoch : file_.epochs) {
      std::stable_sort(epoch.states.begin(), epoch.states.end(),
                       [](const auto& a, const auto& b) { return a.satellite < b.satellite; });
      file_.states += epoch.states.size();
    }
  }

  LineReader lines_;
  Sp3File file_;
  bool time_system_known_ = false;
  bool epoch_is_good_ = false;
  bool ended_ = false;
};

}  // namespace

Sp3File read_sp3(const std::string& path) { return Reader(path).read(); }

}  // namespace leonav
