// A ResetPlan lists what a reset of the filter clears, keeps and marks in the GNSS stage; there are
// four presets.
#pragma once

namespace leonav {

enum class FilterReset : unsigned char {
  kReset,    // nothing remains but the configuration; a later point solution starts it
  kRestart,  // starts at once from a point solution
};
enum class CarrierReset : unsigned char {
  kPosition,  // the arcs go on; the next epoch is not tested against the last one
  kAll,
};

// Every reset clears the evidence for and against the filter (FilterMonitor::clear_evidence): it is
// void for the next one. What is false here stays as it is.
struct ResetPlan {
  FilterReset filter = FilterReset::kReset;
  // Of kRestart.
  bool keeps_vehicle_constants = false;
  bool keeps_attitude = false;  // see AttitudeCarryOver
  CarrierReset carriers = CarrierReset::kPosition;
  bool alignment = false;
  bool external_heading = false;  // it is forgotten, and the heading monitor stops
  bool motion_aiding = false;
  bool outage_monitor = false;
  bool installation_monitor = false;
  // The times of the last GNSS, the last reset and the last restart by rejections are unset. Else
  // they are kept, and this is the last reset.
  bool times = false;
  bool gnss_used = false;  // whether the epoch of the reset counts as one with satellites
};

// A command, or new GPS time: time may begin anew, so nothing that holds a time remains.
inline constexpr ResetPlan kCommandReset = {.filter = FilterReset::kReset,
                                            .carriers = CarrierReset::kAll,
                                            .alignment = true,
                                            .motion_aiding = true,
                                            .outage_monitor = true,
                                            .installation_monitor = true,
                                            .times = true};

// The filter is worth nothing and nothing replaces it: the stage has no position, hence no outage,
// until the next point solution; time goes on, and with it the vehicle's motion.
inline constexpr ResetPlan kDropReset = {.filter = FilterReset::kReset,
                                         .carriers = CarrierReset::kPosition,
                                         .alignment = true,
                                         .outage_monitor = true};

// The heading was wrong from the start or has become so: all that the filter has estimated with it
// is void, and so is the heading it was given; a point solution of this epoch replaces it.
inline constexpr ResetPlan kHeadingReset = {.filter = FilterReset::kRestart,
                                            .carriers = CarrierReset::kPosition,
                                            .alignment = true,
                                            .external_heading = true,
                                            .gnss_used = true};

// Position and velocity are wrong: the filter starts there anew, and a good attitude, which took a
// drive to find, survives with what has been estimated of the IMU; without one it is aligned anew.
constexpr ResetPlan restart_reset(bool keeps_attitude, bool keeps_vehicle_constants) {
  return {.filter = FilterReset::kRestart,
          .keeps_vehicle_constants = keeps_vehicle_constants,
          .keeps_attitude = keeps_attitude,
          .carriers = CarrierReset::kPosition,
          .alignment = !keeps_attitude,
          .gnss_used = true};
}

}  // namespace leonav
