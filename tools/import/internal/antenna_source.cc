#include "tools/import/internal/antenna_source.h"

#include <set>
#include <utility>

#include "drivers/antex/antex_reader.h"

namespace leonav {
namespace {

constexpr const char* kWithoutReceiver =
    ": the receiver antenna's phase centre is taken for its reference point, and heights are off "
    "by "
    "up to 15 cm";

void report_file(const std::string& path, const AntexFile& file, ImportReport* report) {
  const std::string first =
      file.problems.empty() ? path : path + ":" + std::to_string(file.problems[0].line);
  const std::string what = file.problems.empty() ? "" : " (" + file.problems[0].what + ")";
  report->skip(first, "damaged antenna model" + what, static_cast<long>(file.damaged));
  report->skip(path, "satellite antenna that is not valid at the start",
               static_cast<long>(file.not_valid));
  report->skip(path, "antenna model of a system not used", static_cast<long>(file.other_system));
  report->skip(path, "antenna model of a band not used", static_cast<long>(file.unknown_band));
  report->skip(path, "antenna model by azimuth too fine to keep, its mean is used",
               static_cast<long>(file.coarsened));
  if (file.truncated) report->warnings.push_back(path + " ends within an antenna; take it anew");
}

}  // namespace

std::vector<AntennaPattern> load_antennas(const Dataset& dataset, const std::string& header_antenna,
                                          GpsTime time, ImportReport* report) {
  const auto warn = [report](const std::string& text) { report->warnings.push_back(text); };
  if (dataset.antenna_models.empty()) {
    if (!dataset.orbits.empty()) {
      warn(
          "no antenna_models: precise orbits refer to the satellites' mass centres, so ranges are "
          "off by up to metres, most of it common to all satellites; there is no centimetre "
          "solution");
    }
    return {};
  }
  const std::string name =
      antenna_name(dataset.receiver_antenna.empty() ? header_antenna : dataset.receiver_antenna);
  if (name.empty()) {
    std::string text =
        "no receiver antenna named (observation header: ANT # / TYPE; dataset: receiver_antenna)";
    warn(text += kWithoutReceiver);
  }
  std::vector<AntennaPattern> receiver, satellites;
  std::set<SatelliteId> known;
  ReceiverMatch match = ReceiverMatch::kAbsent;
  for (const std::string& path : dataset.antenna_models) {
    AntexFile file = read_antex(path, {time, name});
    report_file(path, file, report);
    std::set<SatelliteId> here;
    for (const AntennaPattern& pattern : file.satellites) {
      if (known.count(pattern.satellite) != 0) continue;
      here.insert(pattern.satellite);
      satellites.push_back(pattern);
    }
    known.merge(here);
    const bool better = receiver.empty() || (match == ReceiverMatch::kWithoutRadome &&
                                             file.match == ReceiverMatch::kExact);
    if (file.receiver.empty() || !better) continue;
    receiver = std::move(file.receiver);
    match = file.match;
    report->receiver_antenna = file.receiver_found;
  }
  if (!name.empty() && receiver.empty()) {
    warn("no antenna model of the receiver antenna '" + name + "'" + kWithoutReceiver);
  } else if (match == ReceiverMatch::kWithoutRadome && !name.empty()) {
    warn("no antenna model of '" + name + "' with its radome: the one without, '" +
         report->receiver_antenna + "', is used, which is off by some millimetres");
  }
  if (satellites.empty()) {
    warn(
        "no antenna model of any satellite valid at the start: with precise orbits ranges are off "
        "by up to metres");
  }
  report->satellite_antennas = static_cast<long>(known.size());
  receiver.insert(receiver.end(), satellites.begin(), satellites.end());
  return receiver;
}

}  // namespace leonav
