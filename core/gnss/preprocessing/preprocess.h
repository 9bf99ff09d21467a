// This unit turns a raw epoch into a MeasurementEpoch: satellite states at transmission,
// corrections, weights, and reasons.
#pragma once
#include <Eigen/Core>
#include <span>

#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/preprocessing/carrier_preprocessor.h"
#include "core/gnss/preprocessing/receiver_code_bias.h"
#include "core/gnss/propagation/antenna_pattern_store.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// Information beside the epoch itself; every part may be missing.
struct PreprocessAids {
  ReceiverCodeBiases* biases =
      nullptr;  // the receiver's delays between bands, updated by this epoch
  CarrierPreprocessor* carriers = nullptr;  // nullptr: no carriers
  const AntennaPatternStore* antennas = nullptr;
  const SignalBiasStore* signal_biases = nullptr;  // of satellites, beside precise clocks
  // Axes of the receiver antenna, forward, right, down, in ECEF; nullptr: north, east, down.
  const Eigen::Matrix3d* C_er = nullptr;
  // Applies SystemConfig::max_satellites; false where a position is sought without a previous one.
  bool caps = true;
  std::span<const SatelliteId> faulty;  // not to be used (Reason::kFaulty)
};

// Computes `epoch` from `raw`. `approximate_p_e` (ECEF, m) is within a kilometre or so of the
// antenna, or zero if unknown. Without it there is no elevation mask, no atmosphere and no carrier,
// which suffices for a first position with which to call again. Every satellite of `raw` appears in
// epoch->satellites with its reason. Where the measurements exceed the capacity of their table, the
// lowest satellites are excluded (Reason::kCapacity).
void preprocess(const RawEpoch& raw, const EphemerisStore& ephemeris_store,
                const GnssConfig& config, const Eigen::Vector3d& approximate_p_e,
                MeasurementEpoch* epoch, const PreprocessAids& aids = {});

}  // namespace leonav
