// Gives every input its place in one total order and cuts the IMU stream at the GNSS epochs.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <memory>

#include "core/navigator/navigator_config.h"
#include "core/navigator/stage_work.h"

namespace leonav {

// Where the Sequencer's work goes. push_* may wait for room, never drop.
class StageInputs {
 public:
  virtual ~StageInputs() = default;
  // Called before the epoch's work is pushed to either stage.
  virtual void open_epoch(std::uint64_t index) = 0;
  virtual void push_inertial(const InertialWork& work) = 0;
  virtual void push_gnss(const GnssWork& work) = 0;
  virtual void event(const Event& event) = 0;  // sequencer's own events, sequence counted per stage
};

// Decides by data alone, so replay decides alike:
// - an epoch is issued when the IMU has passed its time; without IMU
// (MotionModel::kConstantVelocity)
//   at once;
// - an epoch whose IMU does not come is issued without it when kMaxPending later ones are waiting;
// - when the IMU has run 1.5 epoch intervals past the last epoch, an empty epoch is issued, so that
//   blocks stay bounded;
// - an epoch not later than the last issued one is late: counted, dropped, reported;
// - IMU samples must be finite, in range and increasing; a gap is reported and left as a hole.
class Sequencer {
 public:
  static constexpr std::size_t kMaxPending = 4;

  Sequencer(const NavigatorConfig& config, StageInputs* stages);

  void on_imu(const ImuSample& sample);
  void on_raw_epoch(const RawEpoch& epoch);
  void on_ephemeris(const Ephemeris& ephemeris);
  void on_precise_state(const PreciseState& state);
  void on_klobuchar(const KlobucharModel& model);
  void on_command(const Command& command);
  // A message that could not be decoded or failed validation before it got here.
  void on_rejected(InputFault fault);

  struct Counters {
    std::uint64_t imu = 0, epochs = 0, ephemerides = 0, empty_epochs = 0, late_epochs = 0,
                  imu_gaps = 0;
    std::array<std::uint64_t, 16> rejected{};  // by InputFault
  };
  const Counters& counters() const { return counters_; }

 private:
  void reject(InputFault fault);
  void issue_ready_epochs();
  void issue(const RawEpoch* raw, GpsTime time);
  void emit(EventKind kind, std::uint8_t code, double value);

  NavigatorConfig config_;
  StageInputs* stages_;
  Counters counters_;
  GpsTime imu_time_;         // end of the last accepted sample
  GpsTime last_epoch_time_;  // t of the last issued epoch
  std::uint64_t next_index_ = 1;
  std::uint64_t next_event_ = 1;
  boost::container::static_vector<std::unique_ptr<RawEpoch>, kMaxPending + 1> pending_;
  std::unique_ptr<EpochWork> work_;  // block grows here
};

}  // namespace leonav
