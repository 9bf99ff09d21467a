// This unit estimates the receiver's delays between bands from one epoch.
#pragma once
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/preprocessing/internal/candidate.h"
#include "core/gnss/preprocessing/internal/code_correction.h"
#include "core/gnss/preprocessing/receiver_code_bias.h"

namespace leonav {

// Updates `biases` by the epoch. `context` must be without biases, so that the differences are
// those of the measured codes.
void estimate_code_biases(const DelayContext& context, const Candidates& candidates,
                          const MeasurementEpoch& epoch, ReceiverCodeBiases* biases);

}  // namespace leonav
