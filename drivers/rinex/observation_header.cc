#include "drivers/rinex/observation_header.h"

#include <algorithm>
#include <cmath>

#include "core/base/calendar.h"
#include "drivers/rinex/calendar_fields.h"
#include "drivers/rinex/observation_types.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::string_view kLeoLetters = "LMNO";

Eigen::Vector3d vector_field(std::string_view line) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    v[static_cast<Eigen::Index>(i)] = parse_double(columns(line, 14 * i, 14)).value_or(0.0);
  }
  return v;
}

// Returns the names in `line` from column `first`: `width` characters each, of which the last
// `length` form the name.
std::vector<std::string> names_in(std::string_view line, std::size_t first, std::size_t width,
                                  std::size_t length, std::size_t at_most) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < at_most; ++i) {
    const std::string_view name =
        trim(columns(line.substr(0, 60), first + i * width + width - length, length));
    if (name.empty()) break;
    names.emplace_back(name);
  }
  return names;
}

}  // namespace

GpsTime to_gps_time(GpsTime as_written, RinexTimeSystem system) {
  switch (system) {
    case RinexTimeSystem::kGps:
      return as_written;
    case RinexTimeSystem::kBeidou:
      return as_written.plus_nanoseconds(-kBeidouMinusGpsSeconds * kNanosecondsPerSecond);
    case RinexTimeSystem::kUtc: {
      const GpsTime estimate =
          as_written.plus_nanoseconds(leap_seconds(as_written) * kNanosecondsPerSecond);
      return as_written.plus_nanoseconds(leap_seconds(estimate) * kNanosecondsPerSecond);
    }
  }
  return as_written;
}

std::optional<std::string> ObservationHeaderParser::first_line(std::string_view line) {
  const std::string_view label = trim(columns(line, 60, 20));
  if (label == "CRINEX VERS   / TYPE") {
    return "the file is Hatanaka-compressed (Compact RINEX); unpack it with crx2rnx";
  }
  const auto version = parse_double(columns(line, 0, 9));
  if (label != "RINEX VERSION / TYPE" || !version || !(std::abs(*version) < 100.0)) {
    return "does not begin with a RINEX VERSION / TYPE line; give a RINEX observation file";
  }
  const std::string number(trim(columns(line, 0, 9)));
  header_.version_hundredths = static_cast<int>(std::lround(*version * 100.0));
  if (header_.version_hundredths < 200 || header_.version_hundredths >= 400) {
    return "RINEX version " + number +
           " is not supported (2.00 to 3.05 are); convert the file to version 3";
  }
  if (columns(line, 20, 1) != "O") {
    return "this RINEX file is of type '" + std::string(trim(columns(line, 20, 20))) +
           "', not an observation file; list it under its own key";
  }
  const std::string_view system = columns(line, 40, 1);
  header_.file_system = is_blank(system) ? 'G' : system.front();
  if (header_.file_system == 'R') header_.time_system = RinexTimeSystem::kUtc;
  if (header_.file_system == 'C') header_.time_system = RinexTimeSystem::kBeidou;
  return std::nullopt;
}

std::optional<std::string> ObservationHeaderParser::line(std::string_view line) {
  const std::string_view label = trim(columns(line, 60, 20));
  if (label == "SYS / # / OBS TYPES") return types_line(line);
  if (label == "# / TYPES OF OBSERV") return types_line_2(line);
  if (label == "SYS / SCALE FACTOR") return scale_line(line);
  if (label == "APPROX POSITION XYZ") header_.approximate_p_e = vector_field(line);
  if (label == "ANTENNA: DELTA H/E/N") header_.antenna_delta_hen = vector_field(line);
  if (label == "MARKER NAME") header_.marker = trim(columns(line, 0, 60));
  if (label == "ANT # / TYPE") header_.antenna = trim(columns(line, 20, 20));
  if (label == "INTERVAL") header_.interval_s = parse_double(columns(line, 0, 10)).value_or(0.0);
  if (label == "SIGNAL STRENGTH UNIT") {
    const std::string_view unit = trim(columns(line, 0, 20));
    header_.strength_in_dbhz = unit.empty() || unit == "DBHZ" || unit == "DB-HZ";
  }
  if (label == "TIME OF FIRST OBS") {
    const std::string_view system = trim(columns(line, 48, 3));
    if (system == "GPS" || system == "GAL" || system == "QZS" || system == "IRN") {
      header_.time_system = RinexTimeSystem::kGps;
    } else if (system == "BDT" || system == "BDS") {
      header_.time_system = RinexTimeSystem::kBeidou;
    } else if (system == "GLO" || system == "UTC") {
      header_.time_system = RinexTimeSystem::kUtc;
    } else if (!system.empty()) {
      return "time system '" + std::string(system) + "' is not known (GPS, GAL, BDT, GLO, UTC are)";
    }
  }
  return std::nullopt;
}

std::optional<std::string> ObservationHeaderParser::types_line(std::string_view line) {
  if (header_.is_version_2()) return std::nullopt;
  if (line[0] != ' ') {
    open_system_ = line[0];
    const auto count = parse_int(columns(line, 1, 5));
    if (!count || *count < 0 || *count > 999) {
      return "number of observation types is not readable";
    }
    expected_[open_system_] = static_cast<std::size_t>(*count);
    names_[open_system_].clear();
  }
  if (open_system_ == 0) return "continues a list of observation types that has no first line";
  for (std::string& name : names_in(line, 6, 4, 3, 13)) {
    names_[open_system_].push_back(std::move(name));
  }
  return std::nullopt;
}

std::optional<std::string> ObservationHeaderParser::types_line_2(std::string_view line) {
  if (!header_.is_version_2()) return std::nullopt;
  const std::string_view number = columns(line, 0, 6);
  if (!is_blank(number)) {
    const auto count = parse_int(number);
    if (!count || *count < 1 || *count > 999) return "number of observation types is not readable";
    expected_['G'] = static_cast<std::size_t>(*count);
    names_['G'].clear();
  } else if (names_['G'].empty()) {
    return "continues a list of observation types that has no first line";
  }
  for (std::string& name : names_in(line, 6, 6, 2, 9)) names_['G'].push_back(std::move(name));
  return std::nullopt;
}

std::optional<std::string> ObservationHeaderParser::scale_line(std::string_view line) {
  if (line[0] != ' ') {
    const auto factor = parse_double(columns(line, 2, 4));
    if (!factor || !(*factor > 0.0)) return "scale factor is not readable";
    scales_.push_back({line[0], *factor, {}});
  }
  if (scales_.empty()) return "continues a scale factor that has no first line";
  for (std::string& name : names_in(line, 10, 4, 3, 12)) {
    scales_.back().names.push_back(std::move(name));
  }
  return std::nullopt;
}

double ObservationHeaderParser::scale_of(char system, const std::string& name) const {
  double factor = 1.0;
  for (const Scale& scale : scales_) {
    const bool named = std::find(scale.names.begin(), scale.names.end(), name) != scale.names.end();
    if (scale.system == system && (named || scale.names.empty())) factor = scale.factor;
  }
  return factor;
}

std::optional<std::string> ObservationHeaderParser::finish() {
  for (const auto& [system, names] : names_) {
    if (names.size() != expected_[system]) {
      return "announces " + std::to_string(expected_[system]) + " observation types for system '" +
             std::string(1, system) + "' but lists " + std::to_string(names.size());
    }
    if (header_.is_version_2()) {
      for (const char letter : {'G', 'E', 'C', 'L'}) {
        header_.types[letter] = observation_types_2(letter, names);
      }
      continue;
    }
    const bool is_leo = kLeoLetters.find(system) != std::string_view::npos;
    std::vector<ObservationType>& types = header_.types[is_leo ? 'L' : system];
    types.clear();
    for (const std::string& name : names) {
      types.push_back(observation_type_3(system, name, header_.version_hundredths));
      types.back().scale = scale_of(system, name);
    }
  }
  if (header_.types.empty()) {
    return "the header lists no observation types; without them no value has a meaning";
  }
  return std::nullopt;
}

}  // namespace leonav
