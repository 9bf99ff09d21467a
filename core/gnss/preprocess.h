// Raw epoch -> MeasurementEpoch: satellite states at transmission, corrections, weights, reasons.
#pragma once
#include <Eigen/Core>

#include "core/gnss/antenna_catalog.h"
#include "core/gnss/band_bias.h"
#include "core/gnss/carrier_follower.h"
#include "core/gnss/gnss_config.h"
#include "core/gnss/measurement.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"

namespace leonav {

// What may be known besides the epoch itself; all of it may be missing.
struct PreprocessAids {
  BandBiases* biases = nullptr;  // the receiver's delays between bands, updated by this epoch
  CarrierFollower* carriers = nullptr;  // nullptr: no carriers
  const AntennaCatalog* antennas = nullptr;
  // The receiver antenna's axes forward, right, down in ECEF; nullptr: north, east, down.
  const Eigen::Matrix3d* C_er = nullptr;
  // Whether SystemConfig::max_satellites holds: not where a position is sought from nothing.
  bool caps = true;
};

// Fills `epoch` from `raw`. `approximate_p_e` within a kilometre or so of the antenna, or zero if
// unknown: then there is no elevation mask, no atmosphere and no carrier, which suffices for a
// first position from which to call again. Every satellite of `raw` appears in epoch->satellites
// with its reason. Where the table of measurements does not hold them all, the lowest satellites
// are left out (Reason::kCapacity).
void preprocess(const RawEpoch& raw, const SatelliteCatalog& catalog, const GnssConfig& config,
                const Eigen::Vector3d& approximate_p_e, MeasurementEpoch* epoch,
                const PreprocessAids& aids = {});

}  // namespace leonav
