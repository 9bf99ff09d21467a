#include "tools/sim/street/street_errors.h"

#include "tools/sim/street/correlated_street.h"
#include "tools/sim/street/recorded_street.h"

namespace leonav::sim {

std::unique_ptr<StreetErrors> make_street_errors(const Scenario& scenario, SatelliteId satellite) {
  switch (scenario.street_errors.family) {
    case StreetFamily::kCorrelated:
      return std::make_unique<CorrelatedStreet>(scenario.street_errors, scenario.seed,
                                                table_index_of(satellite));
    case StreetFamily::kRecorded:
      return std::make_unique<RecordedStreet>(scenario.street_errors, scenario.seed,
                                              table_index_of(satellite));
    case StreetFamily::kRays:
      break;
  }
  return nullptr;
}

}  // namespace leonav::sim
