#include "tools/connect/stream_keys.h"

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/angle.h"
#include "tools/common/day.h"
#include "tools/connect/in_folder.h"
#include "tools/connect/source_keys.h"

namespace leonav {
namespace {

constexpr double kMegabyte = 1e6;
constexpr double kStandardGravity_m_s2 = 9.80665;

const std::vector<std::pair<std::string, LineColumn>> kColumns = {
    {"skip", LineColumn::kSkip},         {"gyro_x", LineColumn::kGyroX},
    {"gyro_y", LineColumn::kGyroY},      {"gyro_z", LineColumn::kGyroZ},
    {"accel_x", LineColumn::kAccelX},    {"accel_y", LineColumn::kAccelY},
    {"accel_z", LineColumn::kAccelZ},    {"gps_week", LineColumn::kGpsWeek},
    {"gps_tow_s", LineColumn::kGpsTowS}, {"clock_s", LineColumn::kClockS},
    {"clock_ms", LineColumn::kClockMs},  {"clock_us", LineColumn::kClockUs},
    {"clock_ns", LineColumn::kClockNs},  {"interval_s", LineColumn::kIntervalS}};

// Returns whether all columns are known. Unknown ones are skipped.
bool read_columns(ConfigReader& group, std::vector<LineColumn>* columns) {
  std::vector<std::string> names;
  bool are_known = true;
  std::string known;
  for (const auto& [name, column] : kColumns) known += (known.empty() ? "" : ", ") + name;
  group.list("columns", &names, "list of " + known);
  for (const std::string& name : names) {
    const auto found = std::find_if(kColumns.begin(), kColumns.end(),
                                    [&name](const auto& one) { return one.first == name; });
    const bool is_known = found != kColumns.end();
    if (!is_known) group.report("columns", "'" + name + "' is no column; known are " + known);
    columns->push_back(is_known ? found->second : LineColumn::kSkip);
    are_known = are_known && is_known;
  }
  return are_known;
}

void read_axes(ConfigReader& group, std::array<int, 3>* axes) {
  std::vector<std::string> names;
  if (!group.list("axes", &names, "list of the axes that point forward, right, down")) return;
  if (names.size() != 3)
    return group.report("axes", "must have three entries: forward, right, down");
  for (std::size_t i = 0; i < 3; ++i) {
    std::string name = names[i];
    const bool is_negative = name.starts_with('-');
    if (is_negative) name.erase(0, 1);
    if (name != "x" && name != "y" && name != "z") {
      group.report("axes", "'" + names[i] + "' is no axis; use x, y, z, -x, -y, -z");
      continue;
    }
    const int axis = name[0] - 'x' + 1;
    (*axes)[i] = is_negative ? -axis : axis;
  }
}

// Returns whether the columns are what is meant.
bool read_line(ConfigReader& group, LineLayout* layout) {
  const bool are_known = read_columns(group, &layout->columns);
  group.choice<char>("separator",
                     {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blank", ' '}},
                     &layout->separator);
  group.text("prefix", &layout->prefix);
  group.boolean("checksum", &layout->has_checksum);
  group.integer("clock_bits", 8, 64, &layout->clock_bits);
  group.boolean("increments", &layout->are_increments);
  double gyro_scale = 1.0, accel_scale = 1.0;
  if (layout->are_increments) {
    group.choice<double>("gyro_unit", {{"rad", 1.0}, {"deg", kDegree}}, &layout->gyro_unit);
    group.choice<double>("accel_unit", {{"m/s", 1.0}}, &layout->accel_unit);
  } else {
    group.choice<double>("gyro_unit", {{"rad/s", 1.0}, {"deg/s", kDegree}}, &layout->gyro_unit);
    group.choice<double>(
        "accel_unit",
        {{"m/s^2", 1.0}, {"g", kStandardGravity_m_s2}, {"mg", 1e-3 * kStandardGravity_m_s2}},
        &layout->accel_unit);
  }
  group.number("gyro_scale", {-1e9, 1e9}, &gyro_scale);
  group.number("accel_scale", {-1e9, 1e9}, &accel_scale);
  layout->gyro_unit *= gyro_scale;
  layout->accel_unit *= accel_scale;
  read_axes(group, &layout->axes);
  if (!are_known) return false;
  const std::string problem = problem_of(*layout);
  if (!problem.empty()) group.report("columns", problem);
  return problem.empty();
}

// RTCM has times of week alone; of a live stream the host's clock knows the week.
void read_day(ConfigReader& group, StreamConfig* stream) {
  if (!std::holds_alternative<FileOptions>(stream->source)) return;
  std::string date;
  group.text("date", &date);
  const std::optional<GpsTime> day = noon_of(date);
  if (!day)
    group.report("date",
                 "must be the day of the recording, written as 2024-03-20: RTCM 3 gives no week");
  else
    stream->day = *day;
}

void read_imu_scale(ConfigReader& group, std::optional<ImuScale>* imu_scale) {
  std::vector<double> scale;
  group.numbers("imu_scale", {0.0, 1.0}, &scale);
  if (scale.empty()) return;
  if (scale.size() != 2 || scale[0] <= 0.0 || scale[1] <= 0.0) {
    group.report("imu_scale",
                 "must be two numbers above 0: what a count stands for, in rad and m/s");
    return;
  }
  *imu_scale = ImuScale{scale[0], scale[1]};
}

bool has_clock(const LineLayout& layout) {
  return std::any_of(layout.columns.begin(), layout.columns.end(), [](LineColumn column) {
    return column >= LineColumn::kGpsWeek && column <= LineColumn::kClockNs;
  });
}

}  // namespace

void read_stream(ConfigReader& group, const std::string& folder, StreamConfig* stream) {
  group.text("name", &stream->name);
  if (stream->name.empty()) group.report("name", "must be given: messages tell streams by it");
  read_source(group, folder, &stream->source);
  group.choice<FormatKind>("format",
                           {{"ubx", FormatKind::kUbx},
                            {"rtcm3", FormatKind::kRtcm3},
                            {"oem7", FormatKind::kOem7},
                            {"sbf", FormatKind::kSbf},
                            {"vectornav", FormatKind::kVectornav},
                            {"xsens", FormatKind::kXsens},
                            {"imu_line", FormatKind::kImuLine},
                            {"has", FormatKind::kHas},
                            {"b2b", FormatKind::kB2b}},
                           &stream->format);
  if (stream->format == FormatKind::kImuLine) {
    bool has_columns = true;
    group.group("line", [&](ConfigReader& line) { has_columns = read_line(line, &stream->line); });
    group.number("rate_hz", {0.0, 10'000.0}, &stream->stamps.rate_hz);
    if (stream->line.columns.empty()) group.report("line", "must describe the columns");
    if (has_columns && !has_clock(stream->line) && stream->stamps.rate_hz <= 0.0) {
      group.report("rate_hz", "must be given where no column is a time: lines are then counted");
    }
    if (has_columns && has_clock(stream->line) && stream->stamps.rate_hz > 0.0) {
      group.report("rate_hz", "is for lines without a column of time; leave it out");
    }
  }
  if (stream->format == FormatKind::kRtcm3) {
    read_day(group, stream);
    group.boolean("corrections", &stream->is_service);
  }
  const bool has_pages = stream->format == FormatKind::kHas || stream->format == FormatKind::kB2b;
  if (has_pages) stream->is_service = true;
  const bool is_ubx = stream->format == FormatKind::kUbx;
  const bool is_oem7 = stream->format == FormatKind::kOem7;
  const bool is_sbf = stream->format == FormatKind::kSbf;
  if (is_ubx || is_sbf) group.boolean("corrections", &stream->uses_pages);
  if (is_ubx || is_oem7 || is_sbf) group.boolean("inertial", &stream->is_inertial);
  if (is_oem7) read_imu_scale(group, &stream->imu_scale);
  if (is_ubx && stream->is_inertial) {
    group.number("latency_ms", {0.0, 1000.0}, &stream->stamps.latency_s, kKeyMillisecond_s);
  }
  if (stream->format == FormatKind::kUbx || stream->format == FormatKind::kRtcm3 ||
      stream->format == FormatKind::kOem7 || stream->format == FormatKind::kSbf) {
    group.number("repeat_ephemerides_s", {0.0, 3600.0}, &stream->repeat_s);
  } else if (!has_pages) {
    group.number("latency_ms", {0.0, 1000.0}, &stream->stamps.latency_s, kKeyMillisecond_s);
  }
  group.text("record", &stream->record);
  double record_limit_mb = static_cast<double>(stream->record_limit_bytes) / kMegabyte;
  group.number("record_limit_mb", {0.0, 1e9}, &record_limit_mb);
  stream->record_limit_bytes = static_cast<std::uint64_t>(record_limit_mb * kMegabyte);
  stream->record = in_folder(folder, stream->record);
  // A service sends clocks each five or ten seconds, and nothing in between.
  if (stream->is_service) stream->silent_s = 15.0;
  group.number("silent_s", {1.0, 3600.0}, &stream->silent_s);
}

}  // namespace leonav
