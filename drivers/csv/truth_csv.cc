#include "drivers/csv/truth_csv.h"

#include <cmath>

#include "core/base/angle.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

constexpr double kMaxHeight = 1e8;  // m; no vehicle is higher

std::optional<double> read_angle(CsvRows& rows, int column) {
  const std::optional<double> degrees = rows.number(column);
  if (!degrees) return std::nullopt;
  return wrap_to_pi(*degrees * kDegree);
}

std::optional<double> degrees(const std::optional<double>& angle) {
  if (!angle) return std::nullopt;
  return *angle / kDegree;
}

}  // namespace

std::optional<Eigen::Vector3d> read_vector(CsvRows& rows, int x, int y, int z) {
  const std::optional<double> first = rows.number(x), second = rows.number(y),
                              third = rows.number(z);
  if (!first || !second || !third) return std::nullopt;
  return Eigen::Vector3d(*first, *second, *third);
}

TruthColumns::TruthColumns(const CsvRows& rows)
    : week_(rows.column("gps_week")),
      tow_(rows.column("gps_tow_s")),
      latitude_(rows.column("latitude_deg")),
      longitude_(rows.column("longitude_deg")),
      height_(rows.column("height_m")),
      v_north_(rows.column("v_north_m_s")),
      v_east_(rows.column("v_east_m_s")),
      v_down_(rows.column("v_down_m_s")),
      roll_(rows.column("roll_deg")),
      pitch_(rows.column("pitch_deg")),
      yaw_(rows.column("yaw_deg")) {}

TruthPoint TruthColumns::read(CsvRows& rows) const {
  TruthPoint point;
  point.time = rows.time(week_, tow_);
  const std::optional<Eigen::Vector3d> position = read_vector(rows, latitude_, longitude_, height_);
  if (!position) {
    rows.mark_bad("position is missing");
  } else if (std::abs(position->x()) > 90.0 || std::abs(position->y()) > 360.0 ||
             std::abs(position->z()) > kMaxHeight) {
    rows.mark_bad("position is not on this Earth: latitude within 90 deg, longitude within 360");
  } else {
    point.position = {position->x() * kDegree, wrap_to_pi(position->y() * kDegree), position->z()};
  }
  point.v_n = read_vector(rows, v_north_, v_east_, v_down_);
  point.roll = read_angle(rows, roll_);
  point.pitch = read_angle(rows, pitch_);
  point.yaw = read_angle(rows, yaw_);
  return point;
}

void TruthColumns::write(CsvWriter& writer, const TruthPoint& point) {
  writer.time(point.time)
      .number(point.position.latitude / kDegree, 10)
      .number(point.position.longitude / kDegree, 10)
      .number(point.position.height, 4);
  for (int i = 0; i < 3; ++i) {
    writer.number(point.v_n ? std::optional((*point.v_n)[i]) : std::nullopt, 6);
  }
  for (const auto& angle : {point.roll, point.pitch, point.yaw}) writer.number(degrees(angle), 8);
}

TruthCsv read_truth_csv(const std::string& path) {
  CsvRows rows(path, kPositionColumns, kTruthCsvHeader);
  const TruthColumns columns_of(rows);
  TruthCsv truth;
  while (rows.next()) {
    const TruthPoint point = columns_of.read(rows);
    if (rows.bad()) {
      rows.skip();
    } else {
      truth.points.push_back(point);
    }
  }
  rows.drop_disordered(&truth.points, [](const TruthPoint& point) { return point.time; });
  truth.report = rows.finish();
  return truth;
}

void write_truth_csv(const std::string& path, std::span<const TruthPoint> points) {
  CsvWriter writer(path, kTruthCsvHeader);
  for (const TruthPoint& point : points) {
    TruthColumns::write(writer, point);
    writer.end_row();
  }
  writer.close();
}

}  // namespace leonav
