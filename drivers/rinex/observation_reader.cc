#include "drivers/rinex/observation_reader.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "drivers/rinex/calendar_fields.h"
#include "drivers/rinex/observation_record.h"
#include "drivers/rinex/satellite_refusal.h"
#include "drivers/text/line_reader.h"

namespace leonav {
namespace {

constexpr std::size_t kSatellitesPerLine2 = 12;
constexpr std::size_t kValuesPerLine2 = 5;
constexpr std::size_t kColumnsPerLine2 = 80;

bool is_measured(const SignalObservation& signal) {
  return std::isfinite(signal.pseudorange_m) || std::isfinite(signal.carrier_cycles) ||
         std::isfinite(signal.doppler_hz);
}

}  // namespace

struct ObservationReader::State {
  using Signal = std::pair<SatelliteId, SignalCode>;

  explicit State(const std::string& path) : lines(path) {}

  void read_header();
  bool next_epoch_line(EpochLine* epoch);
  bool read_satellite_list_2(EpochLine* epoch, std::string_view line);
  void skip_event(const EpochLine& event);
  enum class Records { kComplete, kSomeMissing, kEndOfFile };
  Records read_records(const EpochLine& line);
  bool read_values_2(std::string* values);
  bool starts_epoch(std::string_view line) const;
  void add_satellite(std::string_view name, std::string_view values);
  void carry_interruptions(SignalObservation* signal);
  bool accept(const EpochLine& line, long line_number, RawEpoch* epoch);
  bool is_version_2() const { return parser.header().is_version_2(); }

  LineReader lines;
  ObservationHeaderParser parser;
  ReadCounts counts;
  long epoch_line_number = 0;
  SatelliteRecord record;                  // kept for its memory
  std::vector<SignalObservation> signals;  // of the epoch, in the order of the file
  EpochCapacity capacity;
  // A loss of lock reported while the carrier was not measured holds until the carrier is measured.
  std::set<Signal> interrupted;
  // After a power failure every signal has lost lock when it first comes back.
  bool power_failed = false;
  std::set<Signal> seen_since_failure;
};

void ObservationReader::State::read_header() {
  std::string_view line;
  if (!lines.next(line)) throw FileError(lines.path(), 0, "the file is empty");
  const auto check = [this](const std::optional<std::string>& problem) {
    if (problem) throw FileError(lines.path(), lines.line_number(), *problem);
  };
  check(parser.first_line(line));
  while (true) {
    if (!lines.next(line)) {
      throw FileError(lines.path(), lines.line_number(), "the file ends within its header");
    }
    if (trim(columns(line, 60, 20)) == "END OF HEADER") break;
    check(parser.line(line));
  }
  check(parser.finish());
}

bool ObservationReader::State::starts_epoch(std::string_view line) const {
  if (!is_version_2()) return !line.empty() && line[0] == '>';
  const auto epoch = parse_epoch_line_2(line);
  if (!epoch) return false;
  if (epoch->is_event()) return true;
  std::vector<std::string> names;
  const auto count = std::min(static_cast<std::size_t>(epoch->count), kSatellitesPerLine2);
  return append_satellites_2(line, parser.header().file_system, count, &names);
}

// Skips to the next line that starts an epoch and can be read.
bool ObservationReader::State::next_epoch_line(EpochLine* epoch) {
  std::string_view line;
  bool in_sequence = true;  // nothing was skipped yet
  while (lines.next(line)) {
    const auto parsed = is_version_2() ? parse_epoch_line_2(line) : parse_epoch_line_3(line);
    if (parsed) {
      *epoch = *parsed;
      if (!is_version_2() || epoch->is_event() || read_satellite_list_2(epoch, line)) return true;
    }
    const bool marked = !line.empty() && line[0] == '>' && !is_version_2();
    if (marked || (in_sequence && !is_blank(line))) {
      counts.skip("epoch line that is not readable", lines.line_number());
    }
    if (!is_blank(line)) in_sequence = false;
  }
  return false;
}

bool ObservationReader::State::read_satellite_list_2(EpochLine* epoch, std::string_view line) {
  auto left = static_cast<std::size_t>(epoch->count);
  while (true) {
    const std::size_t here = std::min(left, kSatellitesPerLine2);
    if (!append_satellites_2(line, parser.header().file_system, here, &epoch->satellites)) {
      return false;
    }
    left -= here;
    if (left == 0) return true;
    if (!lines.next(line)) return true;  // the records will be reported as missing
    if (!is_blank(columns(line, 0, 32))) {
      lines.step_back();
      return false;
    }
  }
}

void ObservationReader::State::skip_event(const EpochLine& event) {
  auto left = static_cast<std::size_t>(event.count);
  if (event.flag == 6 && is_version_2()) {
    const std::size_t types = parser.header().types.at('G').size();
    left = left * ((types + kValuesPerLine2 - 1) / kValuesPerLine2) +
           (left == 0 ? 0 : (left - 1) / kSatellitesPerLine2);
  }
  bool changed = false;
  std::string_view line;
  for (; left > 0 && lines.next(line); --left) {
    if (starts_epoch(line)) {
      counts.skip("event with fewer lines than it says", lines.line_number());
      lines.step_back();
      break;
    }
    if (event.flag == 6) continue;
    if (const auto problem = parser.line(line)) {
      counts.skip("header line within the file: " + *problem, lines.line_number());
    }
    changed = true;
  }
  if (!changed) return;
  if (const auto problem = parser.finish()) {
    counts.skip("header lines within the file: " + *problem, lines.line_number());
  }
}

// Joins the lines of one satellite in RINEX 2.
bool ObservationReader::State::read_values_2(std::string* values) {
  values->clear();
  const std::size_t types = parser.header().types.at('G').size();
  std::string_view line;
  for (std::size_t i = 0; i < types; i += kValuesPerLine2) {
    if (!lines.next(line)) return false;
    if (starts_epoch(line)) {
      lines.step_back();
      return false;
    }
    values->append(line.substr(0, kColumnsPerLine2));
    values->resize((i / kValuesPerLine2 + 1) * kColumnsPerLine2, ' ');
  }
  return true;
}

ObservationReader::State::Records ObservationReader::State::read_records(
    const EpochLine& epoch_line) {
  std::string_view line;
  std::string values;
  for (int i = 0; i < epoch_line.count; ++i) {
    if (is_version_2()) {
      if (static_cast<std::size_t>(i) >= epoch_line.satellites.size()) return Records::kEndOfFile;
      if (!read_values_2(&values)) {
        return lines.next(line) ? (lines.step_back(), Records::kSomeMissing) : Records::kEndOfFile;
      }
      add_satellite(epoch_line.satellites[static_cast<std::size_t>(i)], values);
      continue;
    }
    if (!lines.next(line)) return Records::kEndOfFile;
    if (starts_epoch(line)) {
      lines.step_back();
      return Records::kSomeMissing;
    }
    add_satellite(columns(line, 0, 3), line.substr(std::min<std::size_t>(3, line.size())));
  }
  return Records::kComplete;
}

void ObservationReader::State::carry_interruptions(SignalObservation* signal) {
  const Signal key(signal->satellite, signal->code);
  if (!std::isfinite(signal->carrier_cycles)) {
    if (signal->loss_of_lock) interrupted.insert(key);
    return;
  }
  if (interrupted.erase(key) > 0) signal->loss_of_lock = true;
  if (power_failed && seen_since_failure.insert(key).second) signal->loss_of_lock = true;
}

void ObservationReader::State::add_satellite(std::string_view name, std::string_view values) {
  if (const std::string_view reason = satellite_refusal(name); !reason.empty()) {
    counts.skip(reason, lines.line_number());
    return;
  }
  const SatelliteId satellite = *satellite_from_string(name);
  const char letter = satellite.system == System::kLeo ? 'L' : name[0];
  const ObservationHeader& header = parser.header();
  const auto types = header.types.find(letter);
  if (types == header.types.end()) {
    counts.skip("satellite of a system without observation types in the header",
                lines.line_number());
    return;
  }
  for (const SignalObservation& other : signals) {
    if (other.satellite == satellite) {
      counts.skip("satellite that is twice in an epoch", lines.line_number());
      return;
    }
  }
  parse_values(values, satellite, types->second, header.strength_in_dbhz, &record);
  if (record.damaged_fields > 0) {
    counts.skip("value that is not readable", lines.line_number(), record.damaged_fields);
  }
  for (SignalObservation& signal : record.signals) {
    carry_interruptions(&signal);
    if (is_measured(signal)) signals.push_back(signal);
  }
}

// Returns whether the epoch can be used.
bool ObservationReader::State::accept(const EpochLine& line, long line_number, RawEpoch* epoch) {
  epoch->time = to_gps_time(line.time, parser.header().time_system);
  if (signals.empty()) {
    counts.skip("epoch without a measurement of a used system", line_number);
    return false;
  }
  capacity.fit(&signals, epoch);
  epoch_line_number = line_number;
  ++counts.used;
  return true;
}

ObservationReader::ObservationReader(const std::string& path)
    : state_(std::make_unique<State>(path)) {
  state_->read_header();
}
ObservationReader::~ObservationReader() = default;
ObservationReader::ObservationReader(ObservationReader&&) noexcept = default;
ObservationReader& ObservationReader::operator=(ObservationReader&&) noexcept = default;

bool ObservationReader::next(RawEpoch* epoch) {
  EpochLine line;
  while (state_->next_epoch_line(&line)) {
    if (line.is_event()) {
      state_->skip_event(line);
      continue;
    }
    const long line_number = state_->lines.line_number();
    if (line.flag == 1) {
      state_->power_failed = true;
      state_->seen_since_failure.clear();
    }
    state_->signals.clear();
    switch (state_->read_records(line)) {
      case State::Records::kEndOfFile:
        state_->counts.skip("last epoch, which is cut off", line_number);
        return false;
      case State::Records::kSomeMissing:
        state_->counts.skip("satellite lines that an epoch announces but lacks", line_number);
        break;
      case State::Records::kComplete:
        break;
    }
    if (state_->accept(line, line_number, epoch)) return true;
  }
  return false;
}

const ObservationHeader& ObservationReader::header() const { return state_->parser.header(); }
long ObservationReader::line_number() const { return state_->epoch_line_number; }
const ReadCounts& ObservationReader::counts() const { return state_->counts; }
const CapacityLosses& ObservationReader::losses() const { return state_->capacity.losses(); }

}  // namespace leonav
