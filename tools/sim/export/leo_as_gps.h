// LeoAsGps gives low satellites the names of GPS satellites, for programs that support no low
// satellites.
#pragma once
#include <map>
#include <span>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"
#include "core/gnss/signals/observation.h"
#include "tools/sim/sky/broadcast.h"
#include "tools/sim/sky/products.h"

namespace leonav::sim {

// Low satellites that rise above the mask get the unused GPS names, in order of their numbers, as
// far as there are names.
//
// Real GPS satellites that are in view at the start keep their names and are present in the first
// kStartEpochs epochs only. Programs need them: a point solution that starts from the Earth's
// centre converges with satellites four radii up, but diverges with satellites that are nearer to
// the vehicle than the centre is.
class LeoAsGps {
 public:
  // Both must outlive this object.
  LeoAsGps(const Scenario& scenario, const TrueSky& sky);

  RawEpoch epoch(const RawEpoch& epoch);  // epochs in order of time
  Products products() const;              // without errors, at the low satellites' own nodes
  // Elements of low satellites are fitted to arcs of 20 minutes.
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
