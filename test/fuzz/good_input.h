// Good input after any other: it must bring epochs with IMU samples to the stages.
#pragma once
#include <cstdint>

#include "core/navigator/sequencer/sequencer.h"
#include "support/stages/simple_sample.h"

namespace leonav::test {

// StageInputs that checks what is always true of the Sequencer's work and keeps what the proof
// needs. Throws Finding.
class CheckedStages : public StageInputs {
 public:
  void open_epoch(std::uint64_t index) override;
  void push_inertial(const InertialWork& work) override;
  void push_gnss(const GnssWork& work) override;
  void event(const Event& event) override;

  // The newest epoch that has observations and, with `inertial`, the IMU samples before it.
  GpsTime last_good_epoch() const { return last_good_epoch_; }
  std::uint64_t good_epochs() const { return good_epochs_; }
  std::uint64_t epochs() const { return last_index_; }

 private:
  void check_epoch(const EpochWork& work);

  std::uint64_t opened_ = 0, last_index_ = 0, last_event_ = 0, good_epochs_ = 0;
  GpsTime last_epoch_, last_sample_, last_good_epoch_;
};

// Feeds samples at 200 Hz and epochs at 1 Hz with right stamps, from `base` on, until the Sequencer
// has had as long as its rules allow it: an epoch stamped as far ahead as it accepts one
// (EpochQueue) is waited for, and two more must follow. Throws Finding where the last two did not
// reach the stages with their IMU samples.
void require_recovery(const NavigatorConfig& config, Sequencer* sequencer, CheckedStages* stages,
                      GpsTime base);

// A base that no input can know: `now`, moved by one of ten amounts of time that `hash` chooses.
GpsTime hidden_base(GpsTime now, std::uint64_t hash);

// A simple epoch that is right but for its stamp.
RawEpoch epoch_of(GpsTime time, std::size_t satellites = 1);

}  // namespace leonav::test
