#include "drivers/bias_sinex/bias_record.h"

#include <cmath>
#include <optional>

#include "core/base/calendar.h"
#include "drivers/text/parse.h"
#include "drivers/text/time_system.h"

namespace leonav {
namespace {

constexpr double kNanosecond = 1e-9;
constexpr double kLargestValue_s = 3e-6;  // a thousand metres, as SignalBiasStore takes

bool is_digits(std::string_view text) {
  for (const char c : text) {
    if (c < '0' || c > '9') return false;
  }
  return !text.empty();
}

// A time as YYYY:DDD:SSSSS; all zeros stand for an open end, which is given as the unset time.
struct ParsedTime {
  bool is_good = false;
  GpsTime time;
};

ParsedTime parse_time(std::string_view text, std::string_view time_system) {
  if (text.size() != 14 || text[4] != ':' || text[8] != ':') return {};
  const std::string_view parts[] = {text.substr(0, 4), text.substr(5, 3), text.substr(9, 5)};
  for (const std::string_view part : parts) {
    if (!is_digits(part)) return {};
  }
  const int year = *parse_int(parts[0]), day = *parse_int(parts[1]), second = *parse_int(parts[2]);
  if (year == 0 && day == 0 && second == 0) return {true, {}};
  if (year < 1980 || year > 2099 || day < 1 || day > 366 || second > 86'400) return {};
  return {true, gps_time_of(from_calendar({year, 1, day, 0, 0, static_cast<double>(second)}),
                            time_system)};
}

// Returns the signal of an observable such as C1W; nullopt unless it is one of its system.
std::optional<SignalCode> code_of(std::string_view observable, System system) {
  if (observable.size() != 3 || observable[0] != 'C') return std::nullopt;
  const auto code = signal_from_string(observable.substr(1));
  if (!code || !(frequency_hz(system, code->band) > 0.0)) return std::nullopt;
  return code;
}

bool is_other_satellite(std::string_view name) {
  return name.size() == 3 && name[0] >= 'A' && name[0] <= 'Z' && is_digits(name.substr(1));
}

BiasLine damaged(std::string* why, std::string text) {
  *why = std::move(text);
  return BiasLine::kDamaged;
}

}  // namespace

const GpsTime kNoEnd = from_calendar({2099, 1, 1, 0, 0, 0.0});

BiasLine parse_bias_record(std::string_view line, std::string_view time_system, BiasRecord* record,
                           std::string* why) {
  const auto field = [line](std::size_t first, std::size_t width) {
    return trim(columns(line, first, width));
  };
  const std::string_view kind = field(1, 4), name = field(11, 3), observable_1 = field(25, 4),
                         observable_2 = field(30, 4), unit = field(65, 4);
  if (kind != "OSB" && kind != "DSB") {
    if (kind == "ISB" || kind == "DCB" || kind == "DPB" || kind == "LCB")
      return BiasLine::kOtherKind;
    return damaged(why, "no kind of bias (OSB, DSB or ISB) in columns 2 to 5");
  }
  if (!field(15, 9).empty()) return BiasLine::kStation;
  const auto satellite = satellite_from_string(name);
  if (!satellite) {
    if (is_other_satellite(name)) return BiasLine::kOtherSystem;
    return damaged(why, "no satellite in columns 12 to 14");
  }
  if (observable_1.starts_with('L') || unit == "cyc") return BiasLine::kPhase;
  const auto first = code_of(observable_1, satellite->system);
  const auto second = code_of(observable_2, satellite->system);
  if (!first || (kind == "DSB" && !second) || (kind == "OSB" && !observable_2.empty())) {
    return damaged(why, "the observables in columns 26 to 34 are not those of " +
                            std::string(kind == "OSB" ? "an OSB (one code, as C1C)"
                                                      : "a DSB (two codes, as C1C and C1W)") +
                            " of this system");
  }
  if (kind == "DSB" && *first == *second) return damaged(why, "the difference of a code to itself");
  const ParsedTime from = parse_time(field(35, 14), time_system);
  ParsedTime until = parse_time(field(50, 14), time_system);
  if (!from.is_good || !until.is_good) {
    return damaged(why, "the validity in columns 36 to 64 is not two times as 2024:123:00000");
  }
  if (!until.time.is_set()) until.time = kNoEnd;
  if (until.time <= from.time) return damaged(why, "the validity ends before it begins");
  if (unit != "ns") return damaged(why, "the unit in columns 66 to 69 is not ns");
  const auto value = parse_double(field(70, 21));
  if (!value || std::abs(*value * kNanosecond) > kLargestValue_s) {
    return damaged(why, "the value in columns 71 to 91 is no number of nanoseconds up to 3000");
  }
  const std::string_view slope = field(104, 21);
  if (!slope.empty()) {
    const auto rate = parse_double(slope);
    if (!rate) return damaged(why, "the slope in columns 105 to 125 is unreadable");
    if (*rate != 0.0) return BiasLine::kSlope;
  }
  *record = {*satellite, *first,     second.value_or(SignalCode()),
             from.time,  until.time, *value * kNanosecond};
  return BiasLine::kRecord;
}

}  // namespace leonav
