#include "drivers/rinex/observation_record.h"

#include <array>

#include "drivers/rinex/calendar_fields.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::size_t kObservationWidth = 16;
constexpr int kLossOfLockBit = 1;
constexpr int kHalfCycleBit = 2;

int digit_or_zero(std::string_view field, std::size_t column) {
  return column < field.size() && is_digit(field[column]) ? field[column] - '0' : 0;
}

// Returns the middle of the interval of a digit: n is 6 n to 6 n + 5 dBHz (RINEX 3.05, table 8).
double cn0_from_digit(int digit) { return 6.0 * digit + 3.0; }

// Returns the index of `code` in `signals`, and appends it if it is missing.
std::size_t slot_of(SatelliteId satellite, SignalCode code,
                    std::vector<SignalObservation>* signals) {
  for (std::size_t i = 0; i < signals->size(); ++i) {
    if ((*signals)[i].code == code) return i;
  }
  SignalObservation signal;
  signal.satellite = satellite;
  signal.code = code;
  signals->push_back(signal);
  return signals->size() - 1;
}

// F14.3 ends with a digit in the last of its columns; another field was cut off or shifted.
std::optional<double> value_field(std::string_view field) {
  if (field.size() < 14 || !is_digit(field[13])) return std::nullopt;
  return parse_double(field.substr(0, 14));
}

void store(char kind, double value, SignalObservation* signal) {
  switch (kind) {
    case 'C':
      signal->pseudorange_m = value;
      break;
    case 'L':
      signal->carrier_cycles = value;
      break;
    case 'D':
      signal->doppler_hz = value;
      break;
    case 'S':
      signal->cn0_dbhz = value;
      break;
    default:
      break;
  }
}

// RINEX 2 only: the code that a carrier belongs to is the one of the two that was measured.
SignalCode code_of(const ObservationType& type, const std::vector<SignalObservation>& signals) {
  if (!type.fallback.is_set()) return type.code;
  bool has_code = false, has_fallback = false;
  for (const SignalObservation& signal : signals) {
    const bool measured = signal.pseudorange_m == signal.pseudorange_m;
    if (signal.code == type.code) has_code = measured;
    if (signal.code == type.fallback) has_fallback = measured;
  }
  return !has_code && has_fallback ? type.fallback : type.code;
}

}  // namespace

std::optional<EpochLine> parse_epoch_line_3(std::string_view line) {
  if (line.empty() || line[0] != '>') return std::nullopt;
  EpochLine epoch;
  const std::string_view flag = columns(line, 31, 1);
  const auto count = parse_int(columns(line, 32, 3));
  if (!is_blank(flag)) epoch.flag = is_digit(flag[0]) ? flag[0] - '0' : -1;
  if (epoch.flag < 0 || epoch.flag > 6 || !count || *count < 0) return std::nullopt;
  epoch.count = *count;
  const auto time =
      time_fields(parse_int(columns(line, 2, 4)), columns(line, 7, 2), columns(line, 10, 2),
                  columns(line, 13, 2), columns(line, 16, 2), columns(line, 18, 11));
  if (!time && !epoch.is_event()) return std::nullopt;
  if (time) epoch.time = *time;
  return epoch;
}

std::optional<EpochLine> parse_epoch_line_2(std::string_view line) {
  if (line.size() < 32) return std::nullopt;
  for (const std::size_t blank : {0U, 3U, 6U, 9U, 12U, 26U, 27U}) {
    if (line[blank] != ' ') return std::nullopt;
  }
  EpochLine epoch;
  const std::string_view flag = columns(line, 28, 1);
  const auto count = parse_int(columns(line, 29, 3));
  if (!is_blank(flag)) epoch.flag = is_digit(flag[0]) ? flag[0] - '0' : -1;
  if (epoch.flag < 0 || epoch.flag > 6 || !count || *count < 0) return std::nullopt;
  epoch.count = *count;
  const auto year = parse_int(columns(line, 1, 2));
  const auto time = time_fields(year ? std::optional<int>(complete_year(*year)) : std::nullopt,
                                columns(line, 4, 2), columns(line, 7, 2), columns(line, 10, 2),
                                columns(line, 13, 2), columns(line, 15, 11));
  const bool blank_time = is_blank(columns(line, 0, 26));
  if (!time && !(epoch.is_event() && blank_time)) return std::nullopt;
  if (time) epoch.time = *time;
  return epoch;
}

bool append_satellites_2(std::string_view line, char file_system, std::size_t count,
                         std::vector<std::string>* satellites) {
  for (std::size_t i = 0; i < count; ++i) {
    std::string name(columns(line, 32 + 3 * i, 3));
    if (name.size() != 3 || !is_digit(name[2]) || !(is_digit(name[1]) || name[1] == ' ')) {
      return false;
    }
    if (name[0] == ' ') name[0] = file_system == 'M' ? 'G' : file_system;
    if (name[0] < 'A' || name[0] > 'Z') return false;
    satellites->push_back(name);
  }
  return true;
}

void parse_values(std::string_view values, SatelliteId satellite,
                  const std::vector<ObservationType>& types, bool strength_in_dbhz,
                  SatelliteRecord* record) {
  record->signals.clear();
  record->damaged_fields = 0;
  std::vector<SignalObservation>& signals = record->signals;
  std::array<int, 2> no_digits{};
  std::vector<std::array<int, 2>> strength_digits;  // per signal: of the carrier, of the code

  const auto read = [&](std::size_t i) {
    const ObservationType& type = types[i];
    const std::string_view field = columns(values, kObservationWidth * i, kObservationWidth);
    if (is_blank(field)) return;
    const std::size_t slot = slot_of(satellite, code_of(type, signals), &signals);
    strength_digits.resize(signals.size(), no_digits);
    SignalObservation& signal = signals[slot];
    if (type.kind == 'L') {
      const int lock = digit_or_zero(field, 14);
      if ((lock & kLossOfLockBit) != 0) signal.loss_of_lock = true;
      if ((lock & kHalfCycleBit) != 0) signal.half_cycle_ambiguous = true;
    }
    if (is_blank(field.substr(0, 14))) return;
    const auto value = value_field(field);
    if (!value) {
      ++record->damaged_fields;
    } else if (*value != 0.0 && (type.kind != 'S' || strength_in_dbhz)) {
      store(type.kind, *value / type.scale, &signal);
      if (type.kind == 'L') strength_digits[slot][0] = digit_or_zero(field, 15);
      if (type.kind == 'C') strength_digits[slot][1] = digit_or_zero(field, 15);
    }
  };
  // Pseudoranges come first, because in RINEX 2 the signals of the others depend on them.
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i].kind == 'C') read(i);
  }
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i].kind != 'C' && types[i].kind != 0) read(i);
  }
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const int digit = strength_digits[i][0] != 0 ? strength_digits[i][0] : strength_digits[i][1];
    if (signals[i].cn0_dbhz != signals[i].cn0_dbhz && digit != 0) {
      signals[i].cn0_dbhz = cn0_from_digit(digit);
    }
  }
}

}  // namespace leonav
