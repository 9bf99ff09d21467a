// ResetPlan lists in what the resets of the filter in the GNSS stage differ; there are six
// presets.
#pragma once

namespace leonav {

// The filter's part of a reset.
enum class FilterReset : unsigned char {
  kReset,          // only the configuration remains; a later point solution starts the filter
  kRestart,        // the filter starts at once from a point solution
  kReplaced,       // the filter has taken another estimate's state before
  kForgetAttitude  // the filter goes on without attitude and IMU errors
};
// The carriers' part of a reset.
enum class CarrierReset : unsigned char {
  kPosition,  // the arcs continue; the next epoch is not tested against the last one
  kAll,       // all arcs end
};

// A part that is marked false is not cleared. In addition every reset clears the evidence of
// FilterMonitor's tests (FilterMonitor::clear_evidence) and the sums of SatelliteFaultMonitor,
// because they are void for the next filter. Satellites that are left out stay so, unless
// clears_times is set.
//
// Every reset keeps what is no estimate of the filter:
// - orbits, antenna patterns and the receiver's code biases,
// - the means of FilterMonitor::add_consistency(), from which test_position() learns whether codes
//   have been consistent,
// - a checkpoint without a verdict, and whether the vehicle has turned since the start,
// - the saved calibration, until the first attitude has used it; its learned factors and vehicle
//   constants are for the first start alone,
// - the last source of each satellite's orbit, and how long no satellite has been usable,
// - the numbers and the thinning of events.
//
// Other parts end by themselves. The heading monitor stops at the next epoch whose filter has no
// attitude. CarrierSpeed starts anew, because the carriers give no displacement over a reset. The
// next epoch whose filter has a state is a keyframe, because the filter's process does not
// continue.
struct ResetPlan {
  FilterReset filter = FilterReset::kReset;
  // For kRestart; the filters of kReplaced and kForgetAttitude keep them.
  bool keeps_vehicle_constants = false;
  bool keeps_attitude = false;  // see AttitudeCarryOver
  CarrierReset carriers = CarrierReset::kPosition;
  bool clears_alignment = false;
  bool clears_external_heading = false;  // the heading monitor stops as well
  bool clears_motion_aiding = false;
  bool clears_outage_monitor = false;
  bool clears_installation_monitor = false;
  // The times of the last GNSS, the last reset and the last restart by rejections become unset.
  // Otherwise they are kept, and this reset becomes the last one, unless it only forgets the
  // attitude.
  bool clears_times = false;
  // Not a part of the stage: the epoch of the reset counts as one that used satellites.
  bool counts_as_gnss_epoch = false;
};

// Reset by a command or after a time step. Time may begin anew: the times that decide whether a
// reset is the second one soon after another are cleared. Some times of before remain:
// - those that are replaced before they are compared: of the last epoch, of the last keyframe, of
//   the first epoch that contradicted the filter;
// - those whose difference is limited, so that a leap counts as one interval: in test_position(),
//   MeasurementRejectionMonitor and ReceiverCodeBiases;
// - those whose leap ahead counts as a gap in the IMU samples, which ends trust in a heading of
//   before: in CheckpointValidityMonitor and ExternalHeading; and in ImuGapMonitor, which finds no
//   attitude to end then.
inline constexpr ResetPlan kCommandReset = {.filter = FilterReset::kReset,
                                            .carriers = CarrierReset::kAll,
                                            .clears_alignment = true,
                                            .clears_motion_aiding = true,
                                            .clears_outage_monitor = true,
                                            .clears_installation_monitor = true,
                                            .clears_times = true};

// Reset that drops the filter without a replacement. The stage has no position, hence no outage,
// until the next point solution. Time continues, and with it the vehicle's motion.
inline constexpr ResetPlan kDropReset = {.filter = FilterReset::kReset,
                                         .carriers = CarrierReset::kPosition,
                                         .clears_alignment = true,
                                         .clears_outage_monitor = true};

// Reset after a wrong heading. Everything that the filter has estimated with it is void, and so is
// a heading from outside. A point solution of this epoch replaces the filter.
inline constexpr ResetPlan kHeadingReset = {.filter = FilterReset::kRestart,
                                            .carriers = CarrierReset::kPosition,
                                            .clears_alignment = true,
                                            .clears_external_heading = true,
                                            .counts_as_gnss_epoch = true};

// Reset after a gap in the IMU samples in which the vehicle may have turned in any direction. The
// filter keeps position, velocity, clocks and ambiguities. It loses the attitude, which must be
// aligned again.
inline constexpr ResetPlan kAttitudeReset = {.filter = FilterReset::kForgetAttitude,
                                             .keeps_vehicle_constants = true,
                                             .carriers = CarrierReset::kPosition,
                                             .clears_alignment = true,
                                             .clears_external_heading = true};

// Reset of a filter that has taken over the state of the smoother's window, attitude included.
inline constexpr ResetPlan kWindowReset = {.filter = FilterReset::kReplaced,
                                           .keeps_vehicle_constants = true,
                                           .keeps_attitude = true,
                                           .carriers = CarrierReset::kPosition,
                                           .clears_alignment = true};

// Returns the reset after a wrong position or velocity: the filter restarts from a point solution.
// A good attitude, which took a drive to find, is kept with the estimated IMU errors; otherwise the
// alignment starts anew.
constexpr ResetPlan restart_reset(bool keeps_attitude, bool keeps_vehicle_constants) {
  return {.filter = FilterReset::kRestart,
          .keeps_vehicle_constants = keeps_vehicle_constants,
          .keeps_attitude = keeps_attitude,
          .carriers = CarrierReset::kPosition,
          .clears_alignment = !keeps_attitude,
          .counts_as_gnss_epoch = true};
}

}  // namespace leonav
