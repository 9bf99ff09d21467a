#include "tools/smooth/result_tables.h"

#include <cmath>
#include <string_view>

#include "core/base/angle.h"
#include "drivers/csv/csv_writer.h"
#include "drivers/csv/solution_csv.h"
#include "tools/replay/row_grid.h"
#include "tools/smooth/trajectory.h"

namespace leonav {
namespace {

constexpr std::string_view kResidualsHeader =
    "gps_week,gps_tow_s,satellite,observable,signals,residual,sigma,test_ratio,weight_factor,"
    "elevation_deg";

}  // namespace

long write_solution(const std::string& path, const LogGraph& graph, const BatchResult& result,
                    std::optional<double> rate_hz) {
  SolutionCsvWriter writer(path);
  const Trajectory trajectory(graph, result, Estimate::kSmoothed);
  const auto write = [&writer](const Solution& solution) {
    writer.write(to_solution_row(solution, std::nullopt, std::nullopt));
  };
  if (rate_hz) {
    RowGrid grid(*rate_hz);
    trajectory.for_each_sample([&](const Solution& solution) {
      if (grid.takes(solution.time)) write(solution);
    });
  } else {
    for (int k = 0; k < graph.size(); ++k) write(trajectory.at(k));
  }
  writer.close();
  return writer.rows();
}

void write_forward(const std::string& path, const LogGraph& graph, const BatchResult& result) {
  SolutionCsvWriter writer(path);
  const Trajectory trajectory(graph, result, Estimate::kForward);
  for (int k = 0; k < graph.size(); ++k)
    writer.write(to_solution_row(trajectory.at(k), std::nullopt, std::nullopt));
  writer.close();
}

void write_residuals(const std::string& path, const LogGraph& graph) {
  CsvWriter writer(path, kResidualsHeader);
  for (int k = 0; k < graph.size(); ++k) {
    const LogKeyframe& keyframe = graph.at(k);
    for (const LogMeasurement& measurement : keyframe.measurements) {
      const SatelliteGeometry& satellite =
          keyframe.satellites[measurement.measurement.satellite_index];
      std::string signals = to_string(measurement.measurement.code);
      if (measurement.measurement.second_code.is_set())
        signals += "+" + to_string(measurement.measurement.second_code);
      const double sigma = std::sqrt(measurement.variance);
      writer.time(keyframe.time)
          .text(to_string(satellite.satellite))
          .text(to_string(measurement.measurement.observable))
          .text(signals)
          .number(measurement.residual, 4)
          .number(sigma, 4)
          .number(std::abs(measurement.residual) / sigma, 3)
          .number(measurement.factor, 4)
          .number(satellite.elevation * kDegreesPerRadian, 2)
          .end_row();
    }
  }
  writer.close();
}

}  // namespace leonav
