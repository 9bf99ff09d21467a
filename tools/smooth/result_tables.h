// This unit writes the tables of a smoothed log: solution.csv, forward.csv and residuals.csv.
#pragma once
#include <optional>
#include <string>

#include "core/smoother/batch/batch_smoother.h"

namespace leonav {

// Writes solution.csv: a row per epoch, or per `rate_hz` on a grid anchored to GPS time, at the
// IMU's samples. Returns the rows. These functions throw FileError.
long write_solution(const std::string& path, const LogGraph& graph, const BatchResult& result,
                    std::optional<double> rate_hz);
// Writes forward.csv: a row per epoch, of what came before it alone, with the weights and the
// linearization of the whole log.
void write_forward(const std::string& path, const LogGraph& graph, const BatchResult& result);
// Writes residuals.csv: a row per measurement, at the smoothed states.
void write_residuals(const std::string& path, const LogGraph& graph);

}  // namespace leonav
