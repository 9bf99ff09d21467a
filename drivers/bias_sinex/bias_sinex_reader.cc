#include "drivers/bias_sinex/bias_sinex_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "drivers/bias_sinex/bias_record.h"
#include "drivers/bias_sinex/signal_differences.h"
#include "drivers/text/line_reader.h"
#include "drivers/text/time_system.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxProblems = 20;

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (text = trim(text); !text.empty(); text = trim(text)) {
    const std::size_t end = std::min(text.find(' '), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

// The letters by which the format names time systems; drivers/text has names of three letters.
std::string time_system_of(std::string_view word) {
  const std::map<std::string_view, const char*> letters = {
      {"G", "GPS"}, {"E", "GAL"}, {"C", "BDT"}, {"J", "QZS"}, {"I", "IRN"}, {"R", "UTC"}};
  const auto letter = letters.find(word);
  return letter == letters.end() ? std::string(word) : letter->second;
}

std::optional<System> system_of(std::string_view letter) {
  if (letter == "G") return System::kGps;
  if (letter == "E") return System::kGalileo;
  if (letter == "C") return System::kBeidou;
  return std::nullopt;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : lines_(path) {}

  BiasSinexFile read() {
    read_first_line();
    file_.truncated = true;
    for (std::string_view line; lines_.next(line);) {
      if (line.starts_with("%=ENDBIA") || line.starts_with("%ENDBIA")) {
        file_.truncated = false;
        break;
      }
      take(line);
    }
    make_biases();
    if (file_.biases.empty()) fail_without_biases();
    return std::move(file_);
  }

 private:
  void read_first_line() {
    std::string_view line;
    if (!lines_.next(line))
      throw FileError(lines_.path(), 0, "is empty; expected a Bias-SINEX file");
    if (!line.starts_with("%=BIA")) {
      lines_.fail("does not begin like a Bias-SINEX file ('%=BIA 1.00'); check the file");
    }
    const auto version = parse_double(columns(line, 5, 5));
    if (!version || *version < 0.995 || *version >= 1.995) {
      lines_.fail("is of Bias-SINEX version '" + std::string(trim(columns(line, 5, 5))) +
                  "'; 1.00 is read");
    }
  }

  void take(std::string_view line) {
    if (line.empty() || line[0] == '*') return;
    if (line[0] == '+') {
      block_ = std::string(trim(line.substr(1)));
    } else if (line[0] == '-') {
      block_.clear();
    } else if (block_ == "BIAS/DESCRIPTION") {
      take_description(line);
    } else if (block_ == "BIAS/SOLUTION" && !trim(line).empty()) {
      take_record(line);
    }
  }

  void take_description(std::string_view line) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() >= 2 && words[0] == "TIME_SYSTEM") {
      time_system_ = time_system_of(words[1]);
      if (!is_known_time_system(time_system_)) {
        lines_.fail("time system '" + std::string(words[1]) +
                    "' is not known; use a file in GPS, Galileo, BeiDou or UTC time");
      }
    } else if (words.size() >= 3 && words[0] == "SATELLITE_CLOCK_REFERENCE_OBSERVABLES") {
      take_reference(words);
    }
  }

  void take_reference(const std::vector<std::string_view>& words) {
    const auto system = system_of(words[1]);
    if (!system) return;
    ClockReference reference;
    SignalCode* codes[] = {&reference.first, &reference.second};
    for (std::size_t i = 2; i < words.size() && i < 4; ++i) {
      const auto code =
          words[i].size() == 3 ? signal_from_string(words[i].substr(1)) : std::nullopt;
      if (!code || words[i][0] != 'C' || !(frequency_hz(*system, code->band) > 0.0)) {
        damaged("a clock reference that is no code of its system");
        return;
      }
      *codes[i - 2] = *code;
    }
    if (reference.second.is_set() && reference.first.band == reference.second.band) {
      damaged("a clock reference of two codes on one frequency");
      return;
    }
    references_[*system].push_back(reference);
  }

  void take_record(std::string_view line) {
    BiasRecord record;
    std::string why;
    switch (parse_bias_record(line, time_system_, &record, &why)) {
      case BiasLine::kRecord:
        record.line = lines_.line_number();
        keep(record);
        break;
      case BiasLine::kOtherSystem:
        ++file_.other_system;
        break;
      case BiasLine::kStation:
        ++file_.stations;
        break;
      case BiasLine::kPhase:
        ++file_.phases;
        break;
      case BiasLine::kOtherKind:
        ++file_.other_kind;
        break;
      case BiasLine::kSlope:
        ++file_.slopes;
        break;
      case BiasLine::kDamaged:
        damaged(why);
        break;
    }
  }

  void keep(const BiasRecord& record) {
    std::vector<BiasRecord>& differences = differences_[record.satellite];
    const bool is_difference = record.second.is_set();
    if (records_ == BiasSinexFile::kMaxRecords ||
        (is_difference && differences.size() == BiasSinexFile::kMaxDifferences)) {
      ++file_.beyond_capacity;
      return;
    }
    ++records_;
    if (is_difference) {
      differences.push_back(record);
    } else {
      add(record);
      absolute_.insert(record.satellite);
    }
  }

  void add(const BiasRecord& r) {
    const double bias_m = kSpeedOfLight * r.value_s;
    if (std::abs(bias_m) > kLargestBias_m) {
      return damaged(to_string(r.satellite) + " has a bias of " +
                         std::to_string(std::lround(bias_m)) + " m for its code " +
                         to_string(r.first) + "; the largest is " +
                         std::to_string(std::lround(kLargestBias_m)) + " m",
                     r.line);
    }
    file_.biases.push_back({r.satellite, r.first, BiasKind::kCode, {}, bias_m, r.from, r.until});
  }

  void make_biases() {
    for (const auto& [satellite, differences] : differences_) {
      if (differences.empty()) continue;
      if (absolute_.count(satellite) != 0) {
        file_.beside_absolute += differences.size();
        continue;
      }
      const auto named = references_.find(satellite.system);
      const DifferenceResult result = resolve_differences(
          differences,
          named != references_.end() ? named->second : usual_references(satellite.system));
      for (BiasRecord bias : result.biases) {
        bias.line = differences.front().line;
        add(bias);
      }
      if (!result.biases.empty()) file_.differences += differences.size();
      file_.without_reference += result.unconnected.size();
      for (const SignalCode code : result.unconnected) {
        file_.unconnected.insert({satellite.system, code});
      }
    }
    std::stable_sort(file_.biases.begin(), file_.biases.end(),
                     [](const SignalBias& a, const SignalBias& b) {
                       return std::tuple(a.satellite, a.code, a.valid_from) <
                              std::tuple(b.satellite, b.code, b.valid_from);
                     });
  }

  void damaged(const std::string& what) { damaged(what, lines_.line_number()); }
  void damaged(const std::string& what, long line) {
    ++file_.damaged_lines;
    if (file_.problems.size() < kMaxProblems) file_.problems.push_back({line, what});
  }

  [[noreturn]] void fail_without_biases() const {
    std::string why = "holds no code bias of a satellite that leonav uses";
    if (!file_.problems.empty()) {
      throw FileError(lines_.path(), file_.problems.front().line,
                      file_.problems.front().what + "; the file " + why);
    }
    if (file_.without_reference > 0) {
      why +=
          ": no differences lead to the pair that its clocks refer to (usually GPS C1W and C2W, "
          "Galileo C1C and C5Q, BeiDou C2I and C6I)";
    }
    throw FileError(lines_.path(), 0, why + "; check that it is a complete file");
  }

  LineReader lines_;
  BiasSinexFile file_;
  std::string block_;
  std::string time_system_ = "GPS";
  std::map<System, std::vector<ClockReference>> references_;
  std::map<SatelliteId, std::vector<BiasRecord>> differences_;
  std::set<SatelliteId> absolute_;  // satellites with OSBs
  std::size_t records_ = 0;
};

}  // namespace

BiasSinexFile read_bias_sinex(const std::string& path) { return Reader(path).read(); }

}  // namespace leonav
