#include "drivers/csv/solution_csv.h"
#include "core/base/angle.h"

#include <array>
#include <cmath>

namespace leonav {
namespace {

constexpr std::string_view kPrediction = "prediction";

void write_vector(CsvWriter& writer, const std::optional<Eigen::Vector3d>& vector, double unit,
                  int decimals) {
  for (int i = 0; i < 3; ++i) {
    writer.number(vector ? std::optional((*vector)[i] / unit) : std::nullopt, decimals);
  }
}

// Returns a protection level of a solution, which is NaN where none is known.
std::optional<double> known(double level) {
  return std::isnan(level) ? std::nullopt : std::optional(level);
}

Source read_source(CsvRows& rows, int column) {
  if (rows.blank(column)) return Source::kNone;
  if (rows.text(column) == kPrediction) return Source::kInsOnly;
  for (const Source source :
       {Source::kNone, Source::kAligning, Source::kInsOnly, Source::kEkf, Source::kSmoother}) {
    if (rows.text(column) == to_string(source)) return source;
  }
  rows.mark_bad("source is none of none, aligning, ins, prediction, ekf, smoother");
  return Source::kNone;
}

}  // namespace

SolutionRow to_solution_row(const Solution& solution, std::optional<int> satellites,
                            std::optional<double> pdop) {
  SolutionRow row;
  row.pva.time = solution.time;
  row.pva.position = {solution.latitude, solution.longitude, solution.height};
  row.pva.v_n = solution.v_n;
  row.sigma_p_n = solution.sigma_p_n;
  row.sigma_v_n = solution.sigma_v_n;
  if (solution.has_attitude) {
    row.pva.roll = solution.roll;
    row.pva.pitch = solution.pitch;
    row.pva.yaw = solution.yaw;
    row.sigma_rpy = solution.sigma_rpy;
  }
  row.source = solution.source;
  row.satellites = satellites;
  row.pdop = pdop;
  row.horizontal_protection_m = known(solution.horizontal_protection_m);
  row.vertical_protection_m = known(solution.vertical_protection_m);
  row.heading_protection = known(solution.heading_protection);
  return row;
}

std::string_view source_name(Source source, bool has_attitude) {
  return source == Source::kInsOnly && !has_attitude ? kPrediction : to_string(source);
}

std::string_view source_name(const SolutionRow& row) {
  return source_name(row.source, row.pva.roll.has_value());
}

bool is_prediction(const SolutionRow& row) { return source_name(row) == kPrediction; }

SolutionCsvWriter::SolutionCsvWriter(const std::string& path) : writer_(path, kSolutionCsvHeader) {}

void SolutionCsvWriter::write(const SolutionRow& row) {
  TruthColumns::write(writer_, row.pva);
  write_vector(writer_, row.sigma_p_n, 1.0, 4);
  write_vector(writer_, row.sigma_v_n, 1.0, 4);
  write_vector(writer_, row.sigma_rpy, kDegree, 6);
  writer_.text(source_name(row));
  writer_.text(row.satellites ? std::to_string(*row.satellites) : std::string());
  writer_.number(row.pdop, 2);
  writer_.number(row.horizontal_protection_m, 4);
  writer_.number(row.vertical_protection_m, 4);
  writer_.number(
      row.heading_protection ? std::optional(*row.heading_protection / kDegree) : std::nullopt, 6);
  writer_.end_row();
  ++rows_;
}

void SolutionCsvWriter::close() { writer_.close(); }

SolutionCsv read_solution_csv(const std::string& path) {
  CsvRows rows(path, kPositionColumns, kSolutionCsvHeader);
  const TruthColumns pva(rows);
  constexpr std::array<std::string_view, 9> kSigmaNames = {
      "std_north_m",    "std_east_m",   "std_down_m",    "std_v_north_m_s", "std_v_east_m_s",
      "std_v_down_m_s", "std_roll_deg", "std_pitch_deg", "std_yaw_deg"};
  std::array<int, 9> sigma{};
  for (std::size_t i = 0; i < sigma.size(); ++i) sigma[i] = rows.column(kSigmaNames[i]);
  const int source = rows.column("source"), satellites = rows.column("satellites"),
            pdop = rows.column("pdop"), horizontal = rows.column("protection_horizontal_m"),
            vertical = rows.column("protection_vertical_m"),
            heading = rows.column("protection_heading_deg");

  SolutionCsv solution;
  while (rows.next()) {
    SolutionRow row;
    row.pva = pva.read(rows);
    row.sigma_p_n = read_vector(rows, sigma[0], sigma[1], sigma[2]);
    row.sigma_v_n = read_vector(rows, sigma[3], sigma[4], sigma[5]);
    row.sigma_rpy = read_vector(rows, sigma[6], sigma[7], sigma[8]);
    if (row.sigma_rpy) *row.sigma_rpy *= kDegree;
    row.source = read_source(rows, source);
    row.satellites = parse_int(rows.text(satellites));
    if (!row.satellites && !rows.blank(satellites)) rows.mark_bad("satellites is no whole number");
    row.pdop = rows.number(pdop);
    row.horizontal_protection_m = rows.number(horizontal);
    row.vertical_protection_m = rows.number(vertical);
    row.heading_protection = rows.number(heading);
    if (row.heading_protection) *row.heading_protection *= kDegree;
    if (rows.bad()) {
      rows.skip();
    } else {
      solution.rows.push_back(row);
    }
  }
  rows.drop_disordered(&solution.rows, [](const SolutionRow& row) { return row.pva.time; });
  solution.report = rows.finish();
  return solution;
}

}  // namespace leonav
