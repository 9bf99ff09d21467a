// Low satellites under names of GPS, for programs that know no low satellites.
#pragma once
#include <map>
#include <span>
#include <vector>

#include "core/gnss/antenna_model.h"
#include "core/gnss/observation.h"
#include "tools/sim/sky/broadcast.h"
#include "tools/sim/sky/products.h"

namespace leonav::sim {

// The low satellites that rise above the mask have the GPS names that are free, in order of their
// numbers and as far as names go; real GPS satellites that are in view at the start keep theirs and
// are there in the first kStartEpochs epochs alone. Programs need those: a point solution that
// starts from the Earth's centre finds the vehicle by satellites four radii up, but diverges by
// satellites that are nearer to the vehicle than the centre is.
class LeoAsGps {
 public:
  // Both must outlive it.
  LeoAsGps(const Scenario& scenario, const TrueSky& sky);

  RawEpoch epoch(const RawEpoch& epoch);  // in order of time
  Products products() const;              // without errors, nodes as the low satellites' own
  // Low satellites' elements are fitted to arcs of 20 minutes.
  std::vector<Ephemeris> elements(const BroadcastMessages& messages) const;
  std::vector<AntennaPattern> antennas(std::span<const AntennaPattern> antennas) const;

  static constexpr int kStartEpochs = 10;

 private:
  bool rises(const TrueSatellite& satellite, double last_s) const;
  const Scenario& scenario_;
  const TrueSky& sky_;
  std::map<SatelliteId, SatelliteId> names_;
  int epochs_ = 0;
};

}  // namespace leonav::sim
