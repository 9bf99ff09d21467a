#include "tools/sim/scenario/residual_library.h"
#include "core/base/angle.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace leonav::sim {
namespace {

constexpr std::size_t kMaxRows = 5'000'000;
constexpr char kRemedy[] = "; make the library anew with tools/validate street-residuals";

// Returns the field; the row is bad if it is out of range.
std::optional<double> field(CsvRows& rows, const char* name, double least, double most) {
  const std::optional<double> value = rows.number(rows.column(name));
  if (value && !(*value >= least && *value <= most)) {
    rows.mark_bad(std::string(name) + " is beyond " + std::to_string(std::lround(least)) + " to " +
                  std::to_string(std::lround(most)));
  }
  return value;
}

double needed(CsvRows& rows, const char* name, double least, double most) {
  const std::optional<double> value = field(rows, name, least, most);
  if (!value) rows.mark_bad(std::string(name) + " is missing");
  return value.value_or(0.0);
}

}  // namespace

std::size_t ResidualLibrary::class_of(double elevation) {
  constexpr double kWidth = 15.0 * kDegree;
  return static_cast<std::size_t>(
      std::clamp(elevation / kWidth, 0.0, static_cast<double>(kClasses) - 1.0));
}

// Says which piece the row belongs to, and whether it follows the row before it.
void ResidualLibrary::place_row(CsvRows& rows, double time_s) {
  constexpr double kShortest_s = 0.01, kLongest_s = 60.0, kRounding_s = 2e-3;
  const std::string recording(rows.text(rows.column("recording")));
  const std::string name = recording + "," + std::string(rows.text(rows.column("satellite"))) +
                           "," + std::string(rows.text(rows.column("piece")));
  if (pieces_.empty() || name != piece_name_) {
    pieces_.push_back({rows_.size() + 1, 0.0});
    recording_of_.push_back(recording);
  } else {
    Piece& now = pieces_.back();
    const double interval_s = time_s - last_s_;
    if (now.interval_s == 0.0) now.interval_s = interval_s;
    if (interval_s < kShortest_s || interval_s > kLongest_s) {
      rows.mark_bad("time_s does not follow the row before it, within 60 s");
    } else if (std::abs(interval_s - now.interval_s) > kRounding_s) {
      rows.mark_bad("time_s does not keep the interval of its piece");
    }
    now.end = rows_.size() + 1;
  }
  piece_name_ = name;
  last_s_ = time_s;
  piece_of_.push_back(pieces_.size() - 1);
}

void ResidualLibrary::read_row(CsvRows& rows) {
  constexpr double kMaxCode_m = 1e4, kMaxRate_m_s = 1e3;
  RecordedResidual r;
  const double time_s = needed(rows, "time_s", 0.0, 1e7);
  r.elevation = kDegree * needed(rows, "elevation_deg", -90.0, 90.0);
  r.cn0_loss_db = field(rows, "cn0_loss_db", -60.0, 60.0).value_or(0.0);
  r.code_m = {field(rows, "code_1_m", -kMaxCode_m, kMaxCode_m),
              field(rows, "code_2_m", -kMaxCode_m, kMaxCode_m)};
  r.doppler_m_s = field(rows, "doppler_m_s", -kMaxRate_m_s, kMaxRate_m_s);
  const double carrier = needed(rows, "carrier", 0.0, 3.0);
  r.carrier_m = field(rows, "carrier_m", -kMaxRate_m_s, kMaxRate_m_s);
  if (carrier != std::floor(carrier)) rows.mark_bad("carrier is none of 0, 1, 2, 3");
  if (!r.code_m[0] && r.code_m[1]) rows.mark_bad("code_2_m without code_1_m");
  if (rows_.size() >= kMaxRows) rows.mark_bad("is the row after 5 million others, too many");
  if (!rows.bad()) place_row(rows, time_s);
  r.carrier = static_cast<RecordedCarrier>(carrier);
  rows_.push_back(r);
}

ResidualLibrary::ResidualLibrary(const std::string& path,
                                 const std::vector<std::string>& recordings) {
  CsvRows rows(path, kResidualLibraryHeader, kResidualLibraryHeader);
  while (rows.next()) {
    read_row(rows);
    if (!rows.bad()) continue;
    rows.skip();
    break;
  }
  const CsvReport report = rows.finish();
  if (report.skipped > 0) {
    throw FileError(path, 0, "a row cannot be used: " + report.problems.front() + kRemedy);
  }
  for (Piece& piece : pieces_) piece.interval_s = piece.interval_s > 0.0 ? piece.interval_s : 1.0;
  keep(path, recordings);
}

void ResidualLibrary::keep(const std::string& path, const std::vector<std::string>& recordings) {
  for (const std::string& name : recordings) {
    if (std::ranges::find(recording_of_, name) != recording_of_.end()) continue;
    const std::set<std::string> known(recording_of_.begin(), recording_of_.end());
    std::string names;
    for (const std::string& one : known) names += (names.empty() ? "" : ", ") + one;
    throw FileError(path, 0, "has no recording '" + name + "'; it has " + names);
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::string& own = recording_of_[piece_of_[i]];
    if (!recordings.empty() && std::ranges::find(recordings, own) == recordings.end()) continue;
    by_class_[class_of(rows_[i].elevation)].push_back(i);
  }
}

const std::vector<std::size_t>& ResidualLibrary::rows_near(double elevation) const {
  const std::size_t own = class_of(elevation);
  for (std::size_t distance = 0; distance < kClasses; ++distance) {
    if (own >= distance && !by_class_[own - distance].empty()) return by_class_[own - distance];
    const std::size_t above = own + distance;
    if (above < kClasses && !by_class_[above].empty()) return by_class_[above];
  }
  return by_class_[own];  // not reached: a library has rows
}

}  // namespace leonav::sim
