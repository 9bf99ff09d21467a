// ReceiverClocks starts the receiver clock of each system and follows steps that its noise model
// does not contain.
#pragma once
#include <array>

#include "core/filter/estimate/state_estimate.h"
#include "core/filter/update/filter_measurement.h"
#include "core/filter/update/robust_update.h"
#include "core/gnss/measurement/measurement.h"
#include "core/robust/common_step.h"

namespace leonav {

// Steps that the clocks have taken in one epoch, m; 0: none.
struct ClockSteps {
  double clock_jump_m = 0.0;  // of all codes
  double code_step_m = 0.0;   // the part of clock_jump_m that the carriers did not make
  std::array<double, kMaxSystemTimes> inter_system_step_m{};  // of one system beyond that
};

// The state has one clock offset and drift per system (core/filter/state/clock_model.h). Receivers
// step their clocks by milliseconds, phones by anything; codes may step without their carriers, and
// one system without the others. The tests are those of core/filter/innovation_tests/clock_steps.h.
class ReceiverClocks {
 public:
  explicit ReceiverClocks(const RobustConfig& robust) : robust_(robust) {}

  void reset();
  // Starts the clocks of systems that appear for the first time, from their innovations. Returns
  // true if any was started: the innovations must be computed anew.
  bool start(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
             StateEstimate* estimate, ClockSteps* steps);
  // Finds steps and moves clocks and innovations by them.
  void compensate_steps(const MeasurementEpoch& epoch, RobustUpdate* robust_update,
                        FilterMeasurements* measurements, StateEstimate* estimate,
                        ClockSteps* steps);

  using Counts = std::array<int, kMaxSystemTimes>;
  // Counts, per system, the epochs in a row in which none of its codes was accepted while most of
  // the others' were.
  void count_epochs_without_accepted_code(const Counts& offered, const Counts& accepted);
  // Restarts the clocks of systems that have been rejected for ten epochs, with their ambiguities,
  // which were found with the old offset.
  void restart_rejected(StateEstimate* estimate);
  // Lets restart_rejected() restart all known offsets at the next epoch.
  void restart_offsets(const ClockFlags& known);

 private:
  static double apply_code_step(const MeasurementEpoch& epoch, int system, const CommonStep& step,
                                FilterMeasurements* measurements, StateEstimate* estimate);
  static void apply_clock_step(const MeasurementEpoch& epoch, int system, const CommonStep& step,
                               FilterMeasurements* measurements, StateEstimate* estimate);
  static void compensate_jump(const MeasurementEpoch& epoch, FilterMeasurements* measurements,
                              StateEstimate* estimate, ClockSteps* steps);
  void compensate_inter_system_steps(const MeasurementEpoch& epoch, RobustUpdate* robust_update,
                                     FilterMeasurements* measurements, StateEstimate* estimate,
                                     ClockSteps* steps);

  RobustConfig robust_;
  // Step of a system's codes against the others' in the last epoch that awaits confirmation, m.
  std::array<double, kMaxSystemTimes> pending_inter_system_step_m_{};
  Counts epochs_without_accepted_code_{};
  std::array<bool, kMaxSystemTimes> restarting_{};  // the offset was removed and is to start anew
};

}  // namespace leonav
