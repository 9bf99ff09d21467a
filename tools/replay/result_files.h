// ResultFiles writes the tables of a replay: solution, epochs, satellites, measurements, events and
// constraints.
//
// The files are solution.csv, epochs.csv, satellites.csv, measurements.csv, events.csv; where the
// motion is constrained, constraints.csv; and with the smoother smoothed.csv, its states at a fixed
// lag, and filter.csv, the filter's own estimate, which answers where the smoother is late.
#pragma once
#include <optional>
#include <string>

#include "core/navigator/interface/epoch_report.h"
#include "core/navigator/interface/event.h"
#include "core/navigator/interface/smoother_report.h"
#include "core/navigator/interface/solution.h"
#include "drivers/csv/csv_writer.h"
#include "drivers/csv/solution_csv.h"
#include "tools/replay/row_grid.h"

namespace leonav {

// Returns the columns of each table, a line each: "epochs.csv: gps_week,gps_tow_s,...". The unit is
// the end of a column's name.
std::string table_columns();

// ResultFiles opens its files when it is constructed.
class ResultFiles {
 public:
  // `rate_hz` is the rate of rows of solution.csv, from the SOLUTION stream; nullopt: one row per
  // epoch, with the estimate at the epoch itself. Throws FileError.
  ResultFiles(const std::string& folder, std::optional<double> rate_hz);

  void add(const Solution& solution);
  void add(const EpochReport& report);
  // Call it after the epoch's own report: the row is the smoother's if it has a result.
  void add(const SmootherReport& report);
  void add(const Event& event);
  void close();  // throws FileError
  long solution_rows() const { return solution_.rows(); }

 private:
  void write_row();
  void write_satellites(const EpochReport& report);
  void write_measurements(const EpochReport& report);
  void write_constraints(const EpochReport& report);

  std::optional<RowGrid> grid_;
  std::optional<int> satellites_;
  std::optional<double> pdop_;
  std::optional<SolutionRow> row_;  // row of the last epoch, not written yet
  std::uint64_t row_epoch_ = 0;
  SolutionCsvWriter solution_;
  CsvWriter epochs_, satellites_file_, measurements_, events_;
  std::string folder_;
  std::optional<CsvWriter> constraints_;       // opened for the first constraint
  std::optional<SolutionCsvWriter> smoothed_;  // opened for the first state at a fixed lag
  std::optional<SolutionCsvWriter> filter_;    // opened for the first result of the smoother
};

}  // namespace leonav
