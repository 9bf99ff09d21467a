// This unit linearizes a keyframe's measurements at its estimate: residuals, Jacobian rows, weights
// and information.
#pragma once
#include <Eigen/Core>

#include "core/filter/update/measurement_model.h"
#include "core/smoother/keyframe.h"

namespace leonav {

// One measurement linearized at the keyframe's estimate.
struct LinearMeasurement {
  double residual = 0.0;  // measured minus predicted, m or m/s
  EkfVector row = EkfVector::Zero();
  AntennaVector constants = AntennaVector::Zero();  // derivatives by lever arm and time offset
};

// Returns the derivative of the measurement by a state before the ambiguities. Of the installation
// parameters only lever arm and time offset affect ranges; the derivative by the others is zero.
double row_of(const LinearMeasurement& linear, int state);

// Linearizes a measurement at `state`; of a carrier the residual still contains the ambiguity.
LinearMeasurement linearize(const MeasuredObservable& measurement,
                            const SatelliteGeometry& satellite, const CoreState& state,
                            const AntennaMotion& antenna);

// Returns position and velocity of the keyframe's antenna (ECEF) from its state and the lever arm
// (m).
AntennaMotion antenna_of(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b);
LinearMeasurement linearize(const KeyframeMeasurement& measurement, const Keyframe& keyframe,
                            const AntennaMotion& antenna);
// The same at another state of the keyframe.
AntennaMotion antenna_of(const Keyframe& keyframe, const FilterState& state,
                         const Eigen::Vector3d& lever_arm_b);
LinearMeasurement linearize(const KeyframeMeasurement& measurement, const Keyframe& keyframe,
                            const FilterState& state, const AntennaMotion& antenna);

// The contribution of a keyframe's measurements to the normal equations of its active states.
struct MeasurementInformation {
  EkfCovariance information;  // sum of w h h^T
  EkfCorrection gradient;     // sum of w h r
};
// Sums up the contribution at the present factors.
void accumulate_information(const Keyframe& keyframe, const Eigen::Vector3d& lever_arm_b,
                            MeasurementInformation* sum);

}  // namespace leonav
