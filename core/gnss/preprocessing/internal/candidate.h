// This header describes a satellite of an epoch between the choice of its signals and its
// measurements.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <span>

#include "core/base/capacity.h"
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/preprocessing/signal_selection.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// Data kept beside a SatelliteInView until its measurements are formed.
struct Candidate {
  std::size_t satellite_index = 0;
  std::span<const SignalObservation> observations;
  SelectedSignals signals;
  const Ephemeris* broadcast = nullptr;
};
static_assert(kMaxSatellites >= kMaxObservations, "every satellite of a raw epoch has a place");
using Candidates = boost::container::static_vector<Candidate, kMaxSatellites>;

}  // namespace leonav
