// ResidualLibrary holds errors of measurements as recorded runs had them at their true positions.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/csv/csv_rows.h"

namespace leonav::sim {

inline constexpr std::string_view kResidualLibraryHeader =
    "recording,satellite,piece,time_s,elevation_deg,cn0_loss_db,code_1_m,code_2_m,doppler_m_s,"
    "carrier,carrier_m";

// What a recorded carrier does at one epoch.
enum class RecordedCarrier : std::uint8_t {
  kNone,    // it is not measured
  kBegins,  // and says so
  kGoesOn,
  kSlips,  // by an unknown number of cycles, without saying so
};

// One satellite at one epoch.
struct RecordedResidual {
  double elevation = 0.0;  // rad
  double cn0_loss_db = 0.0;
  // Errors of the first two signals; neither: nothing was received; the first alone: there was one.
  std::array<std::optional<double>, 2> code_m;
  std::optional<double> doppler_m_s;
  RecordedCarrier carrier = RecordedCarrier::kNone;
  std::optional<double> carrier_m;  // error within its arc
};

// The rows of one satellite form pieces, at constant intervals.
class ResidualLibrary {
 public:
  // Reads a file with kResidualLibraryHeader, as tools/validate street-residuals makes it. Throws
  // FileError, with file, line and remedy, for any row that is not whole, out of range or out of
  // order: a row left out would make two epochs neighbours that were none.
  // Of the recordings (the names in the file) only those are kept; none named: all. Throws
  // FileError too if one of them is not in the file.
  explicit ResidualLibrary(const std::string& path,
                           const std::vector<std::string>& recordings = {});

  const RecordedResidual& row(std::size_t i) const { return rows_[i]; }
  std::size_t rows() const { return rows_.size(); }
  // Returns the index behind the last row of the piece of row i, and its interval.
  std::size_t end_of_piece(std::size_t i) const { return pieces_[piece_of_[i]].end; }
  double interval_s(std::size_t i) const { return pieces_[piece_of_[i]].interval_s; }
  // Returns the rows (their indices) of the class of that elevation; if it has none, of the nearest
  // class that has. A class is 15 degrees wide.
  const std::vector<std::size_t>& rows_near(double elevation) const;

 private:
  struct Piece {
    std::size_t end = 0;
    double interval_s = 1.0;
  };
  static constexpr std::size_t kClasses = 6;
  static std::size_t class_of(double elevation);
  void read_row(CsvRows& rows);
  void keep(const std::string& path, const std::vector<std::string>& recordings);
  void place_row(CsvRows& rows, double time_s);

  std::vector<RecordedResidual> rows_;
  std::vector<std::size_t> piece_of_;  // by row
  std::vector<Piece> pieces_;
  std::vector<std::string> recording_of_;  // by piece
  std::string piece_name_;                 // of the piece that is being read
  double last_s_ = 0.0;
  std::array<std::vector<std::size_t>, kClasses> by_class_;
};

}  // namespace leonav::sim
