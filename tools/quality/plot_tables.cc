// This unit writes the CSV tables of a quality analysis for the plots.
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "core/base/angle.h"
#include "tools/common/format.h"
#include "tools/quality/internal/slip_text.h"
#include "tools/quality/quality.h"

namespace leonav {
namespace {

class Table {
 public:
  explicit Table(const std::string& path) : path_(path), file_(path) {}
  void line(const std::string& text) { file_ << text << '\n'; }
  void close() {
    if (!file_.flush()) throw std::runtime_error(path_ + ": cannot be written");
  }

 private:
  std::string path_;
  std::ofstream file_;
};

std::string field(double value, int decimals) {
  return std::isfinite(value) ? format(",%.*f", decimals, value) : ",";
}

std::string time_fields(GpsTime time) { return format("%d,%.3f", time.week(), time.tow_s()); }

}  // namespace

void write_plot_tables(const Quality& quality, const std::string& folder) {
  Table epochs(folder + "/epochs.csv");
  std::string header = "gps_week,gps_tow_s,solved";
  for (const System system : kSystems) {
    header +=
        ",seen_" + std::string(to_string(system)) + ",usable_" + std::string(to_string(system));
  }
  epochs.line(header + ",gdop,pdop,hdop,vdop");
  for (const EpochQuality& e : quality.plot_epochs) {
    std::string row = time_fields(e.time) + (e.solved ? ",1" : ",0");
    for (std::size_t i = 0; i < kSystemCount; ++i)
      row += format(",%d,%d", int{e.seen[i]}, int{e.usable[i]});
    epochs.line(row + field(e.dop.gdop, 3) + field(e.dop.pdop, 3) + field(e.dop.hdop, 3) +
                field(e.dop.vdop, 3));
  }
  epochs.close();

  Table signals(folder + "/signals.csv");
  signals.line(
      "gps_week,gps_tow_s,satellite,signal,elevation_deg,azimuth_deg,cn0_dbhz,multipath_m");
  for (const SignalSample& s : quality.plot_samples) {
    signals.line(time_fields(s.time) + "," + to_string(s.satellite) + "," + to_string(s.code) +
                 field(double{s.elevation} * kDegreesPerRadian, 2) +
                 field(double{s.azimuth} * kDegreesPerRadian, 2) + field(double{s.cn0_dbhz}, 2) +
                 field(double{s.multipath_m}, 3));
  }
  signals.close();

  Table slips(folder + "/slips.csv");
  slips.line("gps_week,gps_tow_s,satellite,signals,elevation_deg,slip,causes");
  for (const ArcBreak& one : quality.breaks) {
    slips.line(time_fields(one.time) + "," + to_string(one.satellite) + "," + signals_text(one) +
               field(one.elevation * kDegreesPerRadian, 2) + (is_slip(one.causes) ? ",1," : ",0,") +
               causes_text(one.causes));
  }
  slips.close();
}

}  // namespace leonav
