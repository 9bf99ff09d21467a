// A keyframe's measurements at its estimate: residuals, rows, their weights and information.
#pragma once
#include <Eigen/Core>

#include "core/ekf/measurement_model.h"
#include "core/smoother/keyframe.h"

namespace leonav {

// One measurement at the keyframe's estimate.
struct LinearMeasurement {
  double residual = 0.0;  // measured less predicted, m or m/s
  EkfVector row = EkfVector::Zero();
  AntennaVector constants = AntennaVector::Zero();  // by lever arm and time offset
};

// Its slope by a state before the ambiguities. Of the vehicle's constants lever arm and time offset
// move ranges, the others none.
double row_of(const LinearMeasurement& linear, int state);

// The antenna of a keyframe, as its state and the lever arm have it.
AntennaMotion antenna_of(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b);
LinearMeasurement linearize(const KeyframeMeasurement& measurement, const Keyframe& keyframe,
                            const AntennaMotion& antenna);

// What a keyframe's measurements add to the normal equations of its active states.
struct MeasurementInformation {
  EkfCovariance information;  // sum of w h h^T
  EkfCorrection gradient;     // sum of w h r
};
// With the factors as they are.
void gather_information(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b,
                        MeasurementInformation* sum);

}  // namespace leonav
