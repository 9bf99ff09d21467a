// What one epoch tells of the receiver's delays between bands.
#pragma once
#include "core/gnss/band_bias.h"
#include "core/gnss/candidate.h"
#include "core/gnss/code_correction.h"
#include "core/gnss/measurement.h"

namespace leonav {

// `context` without biases: differences are of what the receiver measured.
void estimate_biases(const DelayContext& context, const Candidates& candidates,
                     const MeasurementEpoch& epoch, BandBiases* biases);

}  // namespace leonav
