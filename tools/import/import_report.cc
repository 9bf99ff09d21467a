#include "tools/import/import_report.h"

#include <cstdio>
#include <sstream>

#include "core/base/calendar.h"

namespace leonav {
std::string text_of(GpsTime time) {
  const CalendarTime c = to_calendar(time);
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02d-%02d %02d:%02d:%06.3f", c.year, c.month, c.day,
                c.hour, c.minute, c.second);
  return text;
}

void ImportReport::skip(std::string_view where, std::string_view reason, long count) {
  if (count > 0) skipped.push_back({std::string(where), std::string(reason), count});
}

void ImportReport::skip(std::string_view where, const CapacityLosses& losses) {
  skip(where, spare_text(losses), static_cast<long>(losses.spare));
  skip(where, usable_text(losses), static_cast<long>(losses.usable));
}

void skip_all(const std::string& path, const SkipReasons& reasons, ImportReport* report) {
  for (const auto& [reason, count] : reasons) {
    report->skip(path, reason, static_cast<long>(count));
  }
}

void ImportReport::warn_if_most_lost(const std::string& path, const std::string& what, long lost,
                                     long all) {
  if (2 * lost <= all) return;
  warnings.push_back(path + ": MORE THAN HALF of the " + what + " were left out, " +
                     std::to_string(lost) + " of " + std::to_string(all) +
                     ": what is left is not the recording; see the reasons above");
}

std::string to_string(const ImportReport& report) {
  std::ostringstream out;
  out << report.epochs << " GNSS epochs";
  std::string_view separator = " (satellites: ";
  for (const auto& [system, count] : report.satellites) {
    out << separator << to_string(system) << ' ' << count;
    separator = ", ";
  }
  if (!report.satellites.empty()) out << ')';
  out << "\n" << report.imu_samples << " IMU samples\n";
  if (report.odometer_increments > 0) out << report.odometer_increments << " odometer increments\n";
  out << report.ephemerides << " ephemerides, " << report.ionosphere_models
      << " ionosphere models, " << report.orbit_epochs << " precise orbit epochs, "
      << report.clock_epochs << " precise clock epochs\n";
  if (report.corrected_states > 0 || report.signal_biases > 0) {
    out << report.corrected_states << " corrected states, " << report.signal_biases
        << " signal biases\n";
  }
  if (report.satellite_antennas > 0 || !report.receiver_antenna.empty()) {
    out << "antenna models of " << report.satellite_antennas << " satellites, receiver antenna "
        << (report.receiver_antenna.empty() ? "unknown" : report.receiver_antenna) << "\n";
  }
  if (report.first.is_set()) {
    out << "span: " << text_of(report.first) << " to " << text_of(report.last) << " GPS time, "
        << seconds_between(report.last, report.first) << " s\n";
  }
  for (const ImportReport::Skip& skip : report.skipped) {
    out << "left out: " << skip.count << " x " << skip.reason << " (" << skip.where << ")\n";
  }
  for (const std::string& note : report.notes) out << note << "\n";
  for (const std::string& warning : report.warnings) out << "warning: " << warning << "\n";
  return out.str();
}

}  // namespace leonav
