#include "drivers/antex/antex_antenna.h"

#include <cmath>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "core/gnss/signals/band_plan.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::string_view kOtherSystems = "RSJI";  // GLONASS, SBAS, QZSS, NavIC
constexpr int kMaxRows = 361 * 10, kMaxAngles = 1801;

std::string padded(std::string_view text, std::size_t width) {
  std::string result(text.substr(0, width));
  result.resize(width, ' ');
  return result;
}

bool is_other_satellite(std::string_view name) {
  return name.size() == 3 && kOtherSystems.find(name[0]) != std::string_view::npos &&
         is_digit(name[1]) && is_digit(name[2]);
}

// Returns the system of a band's letter; LEO satellites of all four letters share one set of bands.
std::optional<System> system_of(char letter) {
  switch (letter) {
    case 'G':
      return System::kGps;
    case 'E':
      return System::kGalileo;
    case 'C':
      return System::kBeidou;
    case 'L':
    case 'M':
    case 'N':
    case 'O':
      return System::kLeo;
    default:
      return std::nullopt;
  }
}

// Returns the number of points from `first` to `last`, or 0 where the steps do not fit.
int points(double first, double last, double step) {
  if (!(step > 0.0) || !(last >= first)) return 0;
  const double count = (last - first) / step;
  if (count > 1e5 || std::abs(count - std::round(count)) > 1e-6) return 0;
  return static_cast<int>(std::round(count)) + 1;
}

}  // namespace

AntexAntenna::Problem AntexAntenna::line(std::string_view text) {
  const std::string_view label = trim(columns(text, 60, 20));
  // Rows of values extend far beyond column 60; within a band no other line begins with a number
  // there.
  const std::string_view head = trim(columns(text, 0, 8));
  if (in_frequency_ && label != "NORTH / EAST / UP" && label != "END OF FREQUENCY" &&
      label != "COMMENT" && (head == "NOAZI" || parse_double(head))) {
    return values_line(text);
  }
  if (label == "START OF FREQ RMS") {
    in_rms_ = true;
  } else if (label == "END OF FREQ RMS") {
    in_rms_ = false;
  }
  if (in_rms_ || label == "COMMENT") return {};
  if (label == "TYPE / SERIAL NO") return type_line(text);
  if (label == "DAZI") {
    const auto step = parse_double(columns(text, 2, 6));
    if (!step || !(*step >= 0.0)) return "step of azimuth is unreadable";
    azimuth_step_deg_ = *step;
    rows_ = *step > 0.0 ? points(0.0, 360.0, *step) : 0;
    if (*step > 0.0 && (rows_ < 3 || rows_ > kMaxRows))
      return "step of azimuth does not fit a turn";
    return {};
  }
  if (label == "ZEN1 / ZEN2 / DZEN") return grid_line(text);
  if (label == "VALID FROM") return time_line(text, &valid_from_);
  if (label == "VALID UNTIL") return time_line(text, &valid_until_);
  if (label == "START OF FREQUENCY") return start_frequency(text);
  if (label == "END OF FREQUENCY") return end_frequency();
  if (label == "NORTH / EAST / UP") return offset_line(text);
  return {};  // METH / BY, # OF FREQUENCIES, SINEX CODE and additions of later versions
}

AntexAntenna::Problem AntexAntenna::type_line(std::string_view text) {
  if (has_type_) return "second TYPE / SERIAL NO; END OF ANTENNA is missing before it";
  has_type_ = true;
  type_ = padded(columns(text, 0, 20), 20);
  const std::string_view name = trim(columns(text, 20, 20));
  satellite_ = satellite_from_string(name);
  is_satellite_ = satellite_ || is_other_satellite(name);
  if (!is_satellite_) serial_ = name;
  return {};
}

AntexAntenna::Problem AntexAntenna::grid_line(std::string_view text) {
  const auto first = parse_double(columns(text, 2, 6)), last = parse_double(columns(text, 8, 6)),
             step = parse_double(columns(text, 14, 6));
  if (!first || !last || !step || !(*first >= 0.0) || !(*last <= 180.0)) {
    return "zenith angles are unreadable";
  }
  angles_ = *last == *first ? 1 : points(*first, *last, *step);
  if (angles_ < 1 || angles_ > kMaxAngles) return "zenith angles are no whole number of steps";
  first_deg_ = *first;
  step_deg_ = *step;
  return {};
}

AntexAntenna::Problem AntexAntenna::time_line(std::string_view text, GpsTime* time) {
  const auto year = parse_int(columns(text, 0, 6)), month = parse_int(columns(text, 6, 6)),
             day = parse_int(columns(text, 12, 6)), hour = parse_int(columns(text, 18, 6)),
             minute = parse_int(columns(text, 24, 6));
  const auto second = parse_double(columns(text, 30, 13));
  if (!year || !month || !day || !hour || !minute || !second || *year < 1970 || *year > 2199 ||
      *month < 1 || *month > 12 || *day < 1 || *day > 31 || *hour < 0 || *hour > 24 ||
      *minute < 0 || *minute > 60 || !(*second >= 0.0 && *second < 62.0)) {
    return "time of validity is unreadable";
  }
  const GpsTime read = from_calendar({*year, *month, *day, *hour, *minute, *second});
  // An instant before the beginning of GPS time stays unset, which means the same for a start of
  // validity.
  if (read.nanoseconds() > 0) *time = read;
  return {};
}

AntexAntenna::Problem AntexAntenna::start_frequency(std::string_view text) {
  if (in_frequency_) return "START OF FREQUENCY within a frequency";
  if (!has_type_) return "START OF FREQUENCY before TYPE / SERIAL NO";
  if (angles_ == 0) return "START OF FREQUENCY before ZEN1 / ZEN2 / DZEN";
  const std::string_view name = trim(columns(text, 3, 3));
  in_frequency_ = true;
  use_frequency_ = has_offset_ = false;
  mean_.clear();
  by_azimuth_.clear();
  if (name.size() != 3 || !is_digit(name[1]) || !is_digit(name[2])) return "unreadable frequency";
  const auto system = system_of(name[0]);
  if (!system) {
    if (kOtherSystems.find(name[0]) == std::string_view::npos) return "frequency of no system";
    ++other_system_bands_;
  } else if (name[1] != '0' || !is_band_of(*system, name[2])) {
    ++unknown_bands_;
  } else if (satellite_ && satellite_->system != *system) {
    return "frequency of another system than the satellite's";
  } else {
    use_frequency_ = true;
    pattern_ = {};
    pattern_.is_receiver = !is_satellite_;
    pattern_.satellite = satellite_ ? *satellite_ : SatelliteId{*system, 0};
    pattern_.band = name[2];
  }
  return {};
}

AntexAntenna::Problem AntexAntenna::offset_line(std::string_view text) {
  if (!in_frequency_) return "NORTH / EAST / UP outside a frequency";
  if (has_offset_) return "second NORTH / EAST / UP of a frequency";
  for (int axis = 0; axis < 3; ++axis) {
    const auto millimetres = parse_double(columns(text, 10 * static_cast<std::size_t>(axis), 10));
    if (!millimetres) return "offset is unreadable";
    pattern_.offset_m[axis] = *millimetres * 1e-3;
  }
  has_offset_ = true;
  return {};
}

AntexAntenna::Problem AntexAntenna::values_line(std::string_view text) {
  const bool mean = trim(columns(text, 0, 8)) == "NOAZI";
  std::vector<float>& values = mean ? mean_ : by_azimuth_;
  if (mean && !values.empty()) return "second NOAZI of a frequency";
  const auto width = static_cast<std::size_t>(angles_);
  if (!mean) {
    const auto row = static_cast<int>(values.size() / width);
    const double expected = row * azimuth_step_deg_;
    const auto azimuth = parse_double(columns(text, 0, 8));
    if (row >= rows_ || !azimuth || std::abs(*azimuth - expected) > 0.01) {
      return "row of values for an azimuth that is not next";
    }
  }
  for (std::size_t i = 0; i < width; ++i) {
    const auto millimetres = parse_double(columns(text, 8 + 8 * i, 8));
    if (!millimetres || std::abs(*millimetres) > 1e4) return "value is missing or unreadable";
    values.push_back(static_cast<float>(*millimetres * 1e-3));
  }
  if (!trim(columns(text, 8 + 8 * width, text.size())).empty()) return "more values than angles";
  return {};
}

AntexAntenna::Problem AntexAntenna::end_frequency() {
  if (!in_frequency_) return "END OF FREQUENCY without its start";
  in_frequency_ = false;
  if (!use_frequency_) return {};
  if (!has_offset_) return "frequency without NORTH / EAST / UP";
  if (mean_.empty()) return "frequency without NOAZI";
  if (!by_azimuth_.empty() &&
      by_azimuth_.size() != mean_.size() * static_cast<std::size_t>(rows_)) {
    return "frequency with too few azimuths";
  }
  fill_grid(&pattern_.variation);
  patterns_.push_back(pattern_);
  return {};
}

// The grid keeps the azimuths where the model does: for receivers, as fine as the capacity allows.
void AntexAntenna::fill_grid(AntennaGrid* grid) {
  const bool whole = !is_satellite_ && !by_azimuth_.empty();
  const bool fits = by_azimuth_.size() <= kMaxAntennaValues;
  if (whole && !fits) ++coarsened_;
  const std::vector<float>& values = whole && fits ? by_azimuth_ : mean_;
  grid->first_angle = first_deg_ * kDegree;
  grid->angle_step = angles_ > 1 ? step_deg_ * kDegree : 0.0;
  grid->angles = angles_;
  grid->azimuths = whole && fits ? rows_ : 1;
  if (values.size() <= kMaxAntennaValues) grid->values.assign(values.begin(), values.end());
}

AntexAntenna::Problem AntexAntenna::finish() {
  if (!has_type_) return "antenna without TYPE / SERIAL NO";
  if (in_frequency_) return "antenna ends within a frequency";
  for (AntennaPattern& pattern : patterns_) {
    pattern.valid_from = is_satellite_ ? valid_from_ : GpsTime();
    pattern.valid_until = is_satellite_ ? valid_until_ : GpsTime();
    const bool fits = !is_satellite_ || pattern.variation.values.size() <= kMaxNadirValues;
    if (!fits) return "satellite antenna with more nadir angles than leonav keeps";
    if (!is_sane(pattern)) return "values that no antenna has";
  }
  return {};
}

}  // namespace leonav
