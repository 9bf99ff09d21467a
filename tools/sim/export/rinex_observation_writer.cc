#include "tools/sim/export/rinex_observation_writer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace leonav::sim {
namespace {

constexpr const char* kLeoLetters = "LMNO";

std::string letters_of(System system) {
  switch (system) {
    case System::kGps:
      return "G";
    case System::kGalileo:
      return "E";
    case System::kBeidou:
      return "C";
    case System::kLeo:
      return kLeoLetters;
  }
  return {};
}

// Formats as F14.3 with the two flags; blank if not measured, which zero would mean too.
std::string field(double value, char lock_flags) {
  if (!std::isfinite(value)) return std::string(16, ' ');
  std::string text = formatted("%14.3f", value);
  text.push_back(lock_flags);
  text.push_back(' ');
  return text;
}

}  // namespace

RinexObservationWriter::RinexObservationWriter(const std::string& path,
                                               ObservationFileHeader header)
    : file_(path), header_(std::move(header)) {}

void RinexObservationWriter::write_header(GpsTime first) {
  file_.labelled("     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE");
  file_.labelled("leonav-sim", "PGM / RUN BY / DATE");
  file_.labelled(header_.marker, "MARKER NAME");
  file_.labelled("", "OBSERVER / AGENCY");
  file_.labelled(formatted("%-20s%-20s%-20s", "1", "leonav-sim", ""), "REC # / TYPE / VERS");
  file_.labelled(formatted("%-20s%-20s", "1", header_.antenna.c_str()), "ANT # / TYPE");
  const Eigen::Vector3d& p = header_.position_e;
  file_.labelled(formatted("%14.4f%14.4f%14.4f", p.x(), p.y(), p.z()), "APPROX POSITION XYZ");
  file_.labelled(formatted("%14.4f%14.4f%14.4f", 0.0, 0.0, 0.0), "ANTENNA: DELTA H/E/N");
  for (const auto& [system, signals] : header_.signals) {
    for (const char letter : letters_of(system)) {
      std::string line = formatted("%c  %3zu", letter, 4 * signals.size());
      for (const SignalCode code : signals) {
        for (const char kind : {'C', 'L', 'D', 'S'}) {
          line += formatted(" %c%c%c", kind, code.band, code.attribute);
        }
      }
      // A line holds thirteen names.
      for (std::size_t at = 0; at == 0 || at < line.size() - 6; at += 52) {
        file_.labelled(
            (at == 0 ? line.substr(0, 6) : std::string(6, ' ')) + line.substr(6 + at, 52),
            "SYS / # / OBS TYPES");
      }
    }
  }
  file_.labelled("DBHZ", "SIGNAL STRENGTH UNIT");
  file_.labelled(formatted("%10.3f", header_.interval_s), "INTERVAL");
  const CalendarTime c = rounded_calendar(first, 7);
  file_.labelled(formatted("  %04d    %2d    %2d    %2d    %2d%13.7f     GPS", c.year, c.month,
                           c.day, c.hour, c.minute, c.second),
                 "TIME OF FIRST OBS");
  for (const auto& [system, signals] : header_.signals) {
    if (system == System::kLeo) continue;
    for (const SignalCode code : signals) {
      file_.labelled(formatted("%c L%c%c", letters_of(system)[0], code.band, code.attribute),
                     "SYS / PHASE SHIFT");
    }
  }
  file_.labelled("", "END OF HEADER");
  has_header_ = true;
}

bool RinexObservationWriter::lost_lock(const SignalObservation& o, GpsTime time) {
  if (!std::isfinite(o.carrier_cycles)) return o.loss_of_lock;
  const auto [place, first] = last_carrier_.try_emplace({o.satellite, o.code}, time);
  const double since_s = seconds_between(time, std::exchange(place->second, time));
  // The receiver's lock time is in its own clock's time.
  return o.loss_of_lock || (!first && o.lock_time_s < 0.99 * since_s);
}

std::string RinexObservationWriter::fields(const SignalObservation& o, GpsTime time) {
  const int flags = (lost_lock(o, time) ? 1 : 0) + (o.half_cycle_ambiguous ? 2 : 0);
  const char lock = flags == 0 ? ' ' : static_cast<char>('0' + flags);
  return field(o.pseudorange_m, ' ') + field(o.carrier_cycles, lock) + field(o.doppler_hz, ' ') +
         field(o.cn0_dbhz, ' ');
}

void RinexObservationWriter::write(const RawEpoch& epoch) {
  if (!has_header_) write_header(epoch.time);
  // There is one line per satellite; the epoch's observations are sorted by satellite.
  std::vector<std::string> lines;
  SatelliteId satellite;
  for (const SignalObservation& o : epoch.observations) {
    const std::vector<SignalCode>& signals = header_.signals[o.satellite.system];
    const auto place = std::find(signals.begin(), signals.end(), o.code);
    if (place == signals.end()) {
      ++left_out_;
      continue;
    }
    if (lines.empty() || o.satellite != satellite) lines.push_back(to_string(o.satellite));
    satellite = o.satellite;
    const auto column = 3 + 64 * static_cast<std::size_t>(place - signals.begin());
    lines.back().resize(std::max(lines.back().size(), column + 64), ' ');
    lines.back().replace(column, 64, fields(o, epoch.time));
  }
  const CalendarTime c = rounded_calendar(epoch.time, 7);
  file_.line(formatted("> %04d %02d %02d %02d %02d%11.7f  0%3zu", c.year, c.month, c.day, c.hour,
                       c.minute, c.second, lines.size()));
  for (const std::string& line : lines) file_.line(line);
}

void RinexObservationWriter::close() { file_.close(); }

}  // namespace leonav::sim
