// Raw epoch -> MeasurementEpoch: satellite states at transmission, corrections, weights, reasons.
#pragma once
#include <Eigen/Core>

#include "core/gnss/band_bias.h"
#include "core/gnss/gnss_config.h"
#include "core/gnss/measurement.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"

namespace leonav {

// Fills `epoch` from `raw`. `approximate_p_e` within a kilometre or so of the antenna, or zero if
// unknown: then there is no elevation mask and no atmosphere, which suffices for a first position
// from which to call again. Every satellite of `raw` appears in epoch->satellites with its reason.
// Where the table of measurements does not hold them all, the lowest satellites are left out
// (Reason::kCapacity). `biases`: the receiver's delays between
// bands, updated by this epoch; nullptr: estimated from this epoch alone.
void preprocess(const RawEpoch& raw, const SatelliteCatalog& catalog, const GnssConfig& config,
                const Eigen::Vector3d& approximate_p_e, MeasurementEpoch* epoch,
                BandBiases* biases = nullptr);

}  // namespace leonav
