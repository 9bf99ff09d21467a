// Navigator turns IMU and GNSS inputs into solutions; it is the one header for embedding and
// replay.
//
//   struct Printer final : OutputSink {
//     void on_solution(const Solution& solution) override { print(solution); }
//     void on_epoch(const EpochReport&) override {}
//     void on_event(const Event&) override {}
//     void on_decision(const Decision&) override {}
//     void on_smoother(const SmootherReport&) override {}
//   };
//   NavigatorConfig config = default_navigator_config(VehicleKind::kCar);  // SI units, radians
//   config.vehicle.lever_arm_b = {0.3, 0.0, -1.2};
//   Printer sink;
//   Navigator navigator(config, &sink);
//   for (const Decision& decision : recorded) navigator.record(decision);  // replay only
//   for (const Ephemeris& ephemeris : ephemerides) navigator.sequencer().on_ephemeris(ephemeris);
//   navigator.sequencer().on_imu(sample);       // each as it arrives,
//   navigator.sequencer().on_raw_epoch(epoch);  // in any order that follows time roughly
//
// A NavigatorConfig() made without default_navigator_config() uses no satellite system.
//
// The stages (core/navigator/stages) run in the caller's thread, inside the call that feeds an
// input. Sequencer lists the conditions on inputs, OutputSink the outputs.
#pragma once
#include <cstdint>
#include <map>
#include <memory>

#include "core/navigator/interface/decision.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/output_sink.h"
#include "core/navigator/interface/vehicle_defaults.h"
#include "core/navigator/sequencer/sequencer.h"
#include "core/navigator/stages/gnss_stage.h"
#include "core/navigator/stages/inertial_navigator.h"
#include "core/navigator/stages/smoother_stage.h"

namespace leonav {

// Navigator runs all stages by direct calls. Without recorded decisions every result of the filter
// and the smoother is in time.
class Navigator final : private StageInputs, private KeyframeSink, private SolveBudget {
 public:
  // `sink` must outlive the navigator.
  Navigator(const NavigatorConfig& config, OutputSink* sink);

  // Records a decision of a journal, to be repeated when its epoch is processed. Call it for every
  // decision before the first input; it allocates. Results of epochs without a decision are in
  // time.
  void record(const Decision& decision);

  // Returns the Sequencer, which accepts all inputs.
  Sequencer& sequencer() { return sequencer_; }
  const Sequencer& sequencer() const { return sequencer_; }
  // These return the stages, for tests and tools. smoother() is nullptr if the filter gives the
  // solution.
  const GnssStage& gnss() const { return gnss_; }
  const InertialNavigator& inertial() const { return inertial_; }
  const SmootherStage* smoother() const { return smoother_.get(); }

 private:
  void open_epoch(std::uint64_t index) override;
  void push_inertial(const InertialWork& work) override;
  void push_gnss(const GnssWork& work) override;
  void event(const Event& event) override;
  KeyframeInput* next_keyframe(std::uint64_t epoch) override;
  void push_keyframe() override;
  void no_keyframe(const Solution& filter, bool due) override;
  bool result_of(std::uint64_t epoch, SmootherAnchor* result) override;
  bool may_iterate(int iterations_done) override;

  // The recorded decisions about the results of one epoch.
  struct Recorded {
    bool ekf_missed = false, smoother_missed = false, keyframe_skipped = false;
    int iterations = -1;  // of the smoother's solve; -1: not recorded
  };
  OutputSink* sink_;
  std::map<std::uint64_t, Recorded> recorded_;
  int iterations_allowed_ = -1;  // in the current solve; -1: no limit
  TimedMailbox<Anchor> ekf_mailbox_;
  TimedMailbox<SmootherAnchor> smoother_mailbox_;
  std::unique_ptr<KeyframeInput> keyframe_;
  std::unique_ptr<SmootherStage> smoother_;  // nullptr: the filter gives the solution
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
};

}  // namespace leonav
