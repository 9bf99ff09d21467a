#include "tools/import/antenna_models.h"

#include <set>
#include <utility>

namespace leonav {
namespace {

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

const char* const kWithoutReceiverAntenna =
    ": the receiver antenna's phase centre is taken for its reference point, and heights are off "
    "by up to 15 cm";

AntennaModels read_antenna_models(const std::vector<std::string>& paths, const std::string& name,
                                  GpsTime time, ImportReport* report) {
  AntennaModels models;
  std::set<SatelliteId> known;
  ReceiverMatch match = ReceiverMatch::kAbsent;
  for (const std::string& path : paths) {
    AntexFile file = read_antex(path, {time, name});
    report_file(path, file, report);
    std::set<SatelliteId> here;
    for (const AntennaPattern& pattern : file.satellites) {
      if (known.count(pattern.satellite) != 0) continue;
      here.insert(pattern.satellite);
      models.satellites.push_back(pattern);
    }
    known.merge(here);
    const bool better = models.receiver.empty() || (match == ReceiverMatch::kWithoutRadome &&
                                                    file.match == ReceiverMatch::kExact);
    if (file.receiver.empty() || !better) continue;
    models.receiver = std::move(file.receiver);
    match = file.match;
    report->receiver_antenna = file.receiver_found;
  }
  if (!name.empty() && models.receiver.empty()) {
    report->warnings.push_back("no antenna model of the receiver antenna '" + name + "'" +
                               kWithoutReceiverAntenna);
  } else if (match == ReceiverMatch::kWithoutRadome && !name.empty()) {
    report->warnings.push_back("no antenna model of '" + name +
                               "' with its radome: the one without, '" + report->receiver_antenna +
                               "', is used, which is off by some millimetres");
  }
  report->satellite_antennas = static_cast<long>(known.size());
  return models;
}

}  // namespace leonav
