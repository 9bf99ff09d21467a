// Turns every IMU sample into a published solution, from the newest committed anchor.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/ins/bridge.h"
#include "core/ins/mechanization.h"
#include "core/navigator/event_source.h"
#include "core/navigator/navigator_config.h"
#include "core/navigator/solution.h"
#include "core/navigator/stage_work.h"
#include "core/navigator/timed_mailbox.h"

namespace leonav {

// Codes of EventKind::kCapacity from this stage.
enum class InertialCapacity : std::uint8_t {
  kHistory = 0,  // an anchor older than the kept samples could not be used
  kWaiting = 1,  // too many undecided epochs: the oldest was decided before its deadline
};

// - Before the first valid anchor nothing is published.
// - While the smoother gives the answer, the filter's result of an epoch waits for the smoother's
//   deadline and becomes the anchor only if the smoother misses it, or has no answer. From then on
//   the filter's results are used at once, until the smoother is in time again.
// - An anchor without attitude (aligning) is extrapolated at constant velocity.
// - A missed epoch leaves the older anchor in use: the answer goes on, its sigma grows.
// - Short holes in the IMU stream are bridged as in the filter (core/ins/bridge.h), longer ones at
//   constant velocity and attitude with grown sigma.
// - When IMU time runs backwards or leaps, everything is dropped; epochs waiting are decided so
//   that the journal has one decision for each.
// - A restart ends the answer until an anchor that was issued after it. Epochs issued before are
//   decided at their deadlines, so that none is missed for it, but not used; the samples are kept,
//   for the next epoch may be older than the command. Where time changed, everything is dropped.
// - A solution with a number that is none is never published: the anchor is dropped, with an event.
class InertialNavigator {
 public:
  InertialNavigator(const NavigatorConfig& config, TimedMailbox<EkfUpdate>* ekf_mailbox,
                    TimedMailbox<SmootherUpdate>* smoother_mailbox, OutputSink* sink);

  // Allocates nothing, never throws.
  void process(const InertialWork& work);

  Source source() const { return source_; }
  std::uint64_t misses() const { return misses_; }
  std::uint64_t smoother_misses() const { return smoother_misses_; }

 private:
  void on_sample(const ImuSample& sample);
  void on_epoch(const EpochIssued& epoch);
  void on_restart(const Restart& restart);
  // An epoch whose decisions are not all made.
  struct Waiting {
    EpochIssued issued;
    bool ekf_decided = false;
    EkfUpdate held;  // valid: waits for the smoother's deadline
  };
  void decide_due_epochs(GpsTime now);
  void decide(Waiting* waiting, GpsTime now, bool usable);
  void decide_ekf(Waiting* waiting, GpsTime now, bool usable);
  void decide_smoother(Waiting* waiting, GpsTime now, bool usable);
  template <typename Update>
  bool take(TimedMailbox<Update>* mailbox, std::uint8_t number, const EpochIssued& epoch,
            GpsTime now, Update* update);
  bool commit(const EkfUpdate& update, Source source, GpsTime now);
  void step(const ImuSample& sample);
  void bridge(const ImuSample& next);
  void forget_before(GpsTime time);
  void forget_anchor();
  void forget_samples();
  void start_over(GpsTime now);
  void drop_anchor(GpsTime now);
  void report_jump(const Eigen::Vector3d& old_p_e, const PvaCovariance& old_covariance,
                   GpsTime now);
  NavState current(GpsTime now) const;
  PvaCovariance covariance_at(GpsTime now) const;
  Source source_at(GpsTime now) const;
  bool publication_due(const ImuSample& sample);
  void publish(GpsTime now);

  NavigatorConfig config_;
  TimedMailbox<EkfUpdate>* mailbox_;
  TimedMailbox<SmootherUpdate>* smoother_mailbox_;
  OutputSink* sink_;
  EventSource events_;
  std::int64_t solution_period_ns_;
  std::int64_t ins_only_after_ns_;
  boost::circular_buffer<ImuSample> history_;  // since the anchor
  boost::circular_buffer<Waiting> waiting_;    // issued, not decided
  Mechanization mechanization_;
  EkfUpdate anchor_;  // valid: there is one
  Source anchor_source_ = Source::kEkf;
  std::uint64_t last_void_epoch_ = 0;  // this and those before it are no anchors any more
  ImuSample last_sample_;              // before the mechanization's time
  double bridged_s_ = 0.0;             // of constant velocity since the anchor
  double bridge_angle_variance_ = 0.0,
         bridge_velocity_variance_ = 0.0;  // of short holes since then
  GpsTime imu_time_;                       // end of the last sample
  GpsTime last_gnss_time_;                 // of the last anchor that used GNSS
  GpsTime next_solution_due_;
  double pending_jump_m_ = 0.0;  // not published yet
  Source source_ = Source::kNone;
  std::uint64_t misses_ = 0, smoother_misses_ = 0, next_solution_ = 1, next_decision_ = 1;
};

}  // namespace leonav
