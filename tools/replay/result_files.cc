#include "tools/replay/result_files.h"

#include <array>
#include <cmath>
#include <utility>

#include "core/base/angle.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {
namespace {

constexpr std::string_view kEpochsHeader =
    "gps_week,gps_tow_s,epoch,empty,source,satellites,pdop,hdop,vdop,clock_gps_m,clock_galileo_m,"
    "clock_beidou_m,clock_leo_m,drift_gps_m_s,drift_galileo_m_s,drift_beidou_m_s,drift_leo_m_s,nis,"
    "nis_degrees,wet_delay_m,std_wet_delay_m,code_sigma_factor,code_correlation_s,"
    "doppler_sigma_factor,doppler_correlation_s,fault_hypotheses";
constexpr std::string_view kSatellitesHeader =
    "gps_week,gps_tow_s,satellite,reason,used,elevation_deg,azimuth_deg,cn0_dbhz,ephemeris_age_s,"
    "orbit,arc,arc_started,arc_causes";
constexpr std::string_view kConstraintsHeader =
    "gps_week,gps_tow_s,constraint,observation,innovation,innovation_sigma,test_ratio,used,"
    "residual";
constexpr std::string_view kEventsHeader = "gps_week,gps_tow_s,stage,event,code,value";
// By Stage.
constexpr std::array<std::string_view, 4> kStageNames = {"sequencer", "inertial", "gnss",
                                                         "smoother"};
constexpr std::array<std::string_view, 9> kConstraintNames = {
    "side",       "vertical",        "standing_x",      "standing_y",
    "standing_z", "standing_rate_x", "standing_rate_y", "standing_rate_z",
    "odometer"};
constexpr std::string_view kMeasurementsHeader =
    "gps_week,gps_tow_s,satellite,observable,signals,observation,innovation,innovation_sigma,"
    "test_ratio,weight_factor,reason,residual,elevation_deg";

std::string_view name_of(OrbitSource source) {
  switch (source) {
    case OrbitSource::kNone:
      return "none";
    case OrbitSource::kBroadcast:
      return "broadcast";
    case OrbitSource::kPrecise:
      return "precise";
  }
  return "none";
}

// Returns "geometry_free|doppler"; empty if there is no cause.
std::string to_string(SlipCauses causes) {
  std::string names;
  for (const SlipCause cause : kSlipCauses) {
    if (!causes.has(cause)) continue;
    if (!names.empty()) names += '|';
    names += to_string(cause);
  }
  return names;
}

double elevation_of(const EpochReport& report, SatelliteId satellite) {
  for (const SatelliteReport& candidate : report.satellites)
    if (candidate.satellite == satellite) return candidate.elevation;
  return 0.0;
}

}  // namespace

std::string table_columns() {
  constexpr std::pair<std::string_view, std::string_view> kTables[] = {
      {"solution.csv, smoothed.csv, filter.csv", kSolutionCsvHeader},
      {"epochs.csv", kEpochsHeader},
      {"satellites.csv", kSatellitesHeader},
      {"measurements.csv", kMeasurementsHeader},
      {"events.csv", kEventsHeader},
      {"constraints.csv", kConstraintsHeader}};
  std::string text;
  for (const auto& [name, columns] : kTables)
    text.append(name).append(": ").append(columns).append("\n");
  return text;
}

ResultFiles::ResultFiles(const std::string& folder, std::optional<double> rate_hz)
    : solution_(folder + "/solution.csv"),
      epochs_(folder + "/epochs.csv", kEpochsHeader),
      satellites_file_(folder + "/satellites.csv", kSatellitesHeader),
      measurements_(folder + "/measurements.csv", kMeasurementsHeader),
      events_(folder + "/events.csv", kEventsHeader),
      folder_(folder) {
  if (rate_hz) grid_.emplace(*rate_hz);
}

void ResultFiles::add(const Solution& solution) {
  if (!grid_ || solution.source == Source::kNone || !grid_->takes(solution.time)) return;
  solution_.write(to_solution_row(solution, satellites_, pdop_));
}

void ResultFiles::add(const EpochReport& report) {
  satellites_ = report.satellites_used;
  pdop_ = report.pdop > 0.0 ? std::optional(report.pdop) : std::nullopt;
  if (!grid_ && report.solution.source != Source::kNone) {
    write_row();
    row_ = to_solution_row(report.solution, satellites_, pdop_);
    row_epoch_ = report.index;
    if (filter_) filter_->write(*row_);
  }
  epochs_.time(report.time)
      .number(static_cast<double>(report.index), 0)
      .number(report.empty ? 1.0 : 0.0, 0)
      .text(source_name(report.solution.source, report.solution.has_attitude))
      .number(report.satellites_used, 0)
      .number(report.pdop, 2)
      .number(report.hdop, 2)
      .number(report.vdop, 2);
  for (const double clock : report.clock_m) epochs_.number(clock, 3);
  for (const double drift : report.clock_drift_m_s) epochs_.number(drift, 4);
  epochs_.number(report.nis, 3)
      .number(report.nis_degrees, 0)
      .number(report.wet_delay_m, 4)
      .number(report.wet_delay_sigma_m, 4);
  for (const LearnedError& error :
       {report.learned_errors.code.all, report.learned_errors.doppler.all})
    epochs_.number(error.sigma_factor, 3).number(error.correlation_time_s, 2);
  epochs_.number(static_cast<double>(report.fault_hypotheses.size()), 0).end_row();
  write_satellites(report);
  write_measurements(report);
  write_constraints(report);
}

void ResultFiles::add(const SmootherReport& report) {
  if (report.lagged.source != Source::kNone) {
    if (!smoothed_) smoothed_.emplace(folder_ + "/smoothed.csv");
    smoothed_->write(to_solution_row(report.lagged, std::nullopt, std::nullopt));
  }
  if (row_ && !filter_) {
    filter_.emplace(folder_ + "/filter.csv");
    filter_->write(*row_);
  }
  if (!row_ || row_epoch_ != report.index || report.solution.source != Source::kSmoother) return;
  row_ = to_solution_row(report.solution, row_->satellites, row_->pdop);
}

void ResultFiles::add(const Event& event) {
  if (event.time.is_set())
    events_.time(event.time);
  else
    events_.text("").text("");
  events_.text(kStageNames[static_cast<std::size_t>(event.stage)])
      .text(to_string(event.kind))
      .number(event.code, 0)
      .number(event.value, 6)
      .end_row();
}

void ResultFiles::write_row() {
  if (row_) solution_.write(*row_);
  row_.reset();
}

void ResultFiles::write_satellites(const EpochReport& report) {
  for (const SatelliteReport& satellite : report.satellites) {
    satellites_file_.time(report.time)
        .text(to_string(satellite.satellite))
        .text(to_string(satellite.reason))
        .number(is_used(satellite.reason) ? 1.0 : 0.0, 0)
        .number(satellite.elevation * kDegreesPerRadian, 2)
        .number(satellite.azimuth * kDegreesPerRadian, 2)
        .number(satellite.cn0_dbhz, 1)
        .number(satellite.ephemeris_age_s, 1)
        .text(name_of(satellite.source))
        .number(satellite.arc, 0)
        .number(satellite.arc_started ? 1.0 : 0.0, 0)
        .text(to_string(satellite.arc_causes))
        .end_row();
  }
}

void ResultFiles::write_measurements(const EpochReport& report) {
  for (const AidingReport& aiding : report.aiding) {
    std::string signals = to_string(aiding.code);
    if (aiding.second_code.is_set()) signals += "+" + to_string(aiding.second_code);
    measurements_.time(report.time)
        .text(to_string(aiding.satellite))
        .text(to_string(aiding.observable))
        .text(signals)
        .number(aiding.observation, 4)
        .number(aiding.innovation, 4)
        .number(std::sqrt(aiding.innovation_variance), 4)
        .number(aiding.test_ratio, 3)
        .number(aiding.weight_factor, 4)
        .text(to_string(aiding.reason))
        .number(aiding.residual, 4)
        .number(elevation_of(report, aiding.satellite) * kDegreesPerRadian, 2)
        .end_row();
  }
}

void ResultFiles::write_constraints(const EpochReport& report) {
  if (report.constraint_reports.empty()) return;
  if (!constraints_) constraints_.emplace(folder_ + "/constraints.csv", kConstraintsHeader);
  for (const ConstraintReport& one : report.constraint_reports) {
    constraints_->time(one.time)
        .text(kConstraintNames.at(static_cast<std::size_t>(one.component)))
        .number(one.observation, 6)
        .number(one.innovation, 6)
        .number(std::sqrt(one.innovation_variance), 6)
        .number(one.test_ratio, 3)
        .number(one.used ? 1.0 : 0.0, 0)
        .number(one.residual, 6)
        .end_row();
  }
}

void ResultFiles::close() {
  write_row();
  solution_.close();
  epochs_.close();
  satellites_file_.close();
  measurements_.close();
  events_.close();
  if (constraints_) constraints_->close();
  if (smoothed_) smoothed_->close();
  if (filter_) filter_->close();
}

}  // namespace leonav
