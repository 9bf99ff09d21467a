// Good input after any other: it must bring epochs with IMU samples to the stages.
#pragma once
#include <cstdint>

#include "core/navigator/sequencer/sequencer.h"
#include "support/stages/simple_sample.h"

namespace leonav::test {

inline constexpr std::int64_t kMs = 1'000'000, kSecond = 1'000 * kMs;  // ns

// StageInputs that checks what is always true of the Sequencer's work and keeps what the proof
// needs. Throws Finding.
class CheckedStages : public StageInputs {
 public:
  void open_epoch(std::uint64_t index) override;
  void push_inertial(const InertialWork& work) override;
  void push_gnss(const GnssWork& work) override;
  void event(const Event& event) override;

  // The two newest epochs with observations.
  struct Epoch {
    GpsTime time;
    bool has_samples = false;  // with IMU samples up to it
  };
  const Epoch& newest() const { return newest_; }
  const Epoch& before_newest() const { return before_newest_; }

 private:
  void check_epoch(const EpochWork& work);

  std::uint64_t opened_ = 0, last_index_ = 0, last_event_ = 0;
  GpsTime last_epoch_, last_sample_;
  Epoch newest_, before_newest_;
};

// Samples and epochs at 1 Hz with right stamps, from `base` on.
struct GoodInput {
  GpsTime base;
  std::int64_t sample_interval_ns = 5'000'000;
  bool stops_early = false;  // once two epochs in a row have reached the stages
};

// Good input that no script can know: its base is `now`, moved by one of ten amounts of time that
// `hash` chooses. `is_whole`: it has samples at 200 Hz and lasts as long as it may; otherwise it
// has some at 50 Hz and stops early, which takes a tenth of the time.
GoodInput hidden_good_input(GpsTime now, std::uint64_t hash, bool is_whole);

// Feeds good input until the Sequencer has had as long as its rules allow it: an epoch stamped as
// far ahead as it accepts one (EpochStamps) is waited for, and two more must follow. Throws Finding
// where the last two did not reach the stages with their IMU samples, unless one of the last three
// was late, and two before it did.
void require_recovery(const NavigatorConfig& config, Sequencer* sequencer, CheckedStages* stages,
                      const GoodInput& good);

// A simple epoch that is right but for its stamp.
RawEpoch epoch_of(GpsTime time, std::size_t satellites = 1);

}  // namespace leonav::test
