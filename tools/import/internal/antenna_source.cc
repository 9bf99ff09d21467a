#include "tools/import/internal/antenna_source.h"

#include <utility>

#include "tools/import/antenna_models.h"

namespace leonav {

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
    warn(text += kWithoutReceiverAntenna);
  }
  AntennaModels models = read_antenna_models(dataset.antenna_models, name, time, report);
  if (models.satellites.empty()) {
    warn(
        "no antenna model of any satellite valid at the start: with precise orbits ranges are off "
        "by up to metres");
  }
  std::vector<AntennaPattern> all = std::move(models.receiver);
  all.insert(all.end(), models.satellites.begin(), models.satellites.end());
  return all;
}

}  // namespace leonav
