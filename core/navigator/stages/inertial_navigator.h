// InertialNavigator turns every IMU sample into a published solution, from the newest anchor.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/navigator/interface/event_source.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/interface/timed_mailbox.h"
#include "core/navigator/stages/internal/anchor_propagation.h"
#include "core/navigator/stages/internal/pending_decisions.h"

namespace leonav {

// Codes of EventKind::kCapacity from the inertial stage. The value is the epoch's index.
enum class InertialCapacity : std::uint8_t {
  kHistory = 0,  // an anchor older than the kept samples could not be used
  kWaiting = 1,  // too many epochs are undecided: the oldest was decided before its deadline
};

// InertialNavigator decides which result of the filter or the smoother becomes the anchor
// (PendingDecisions) and publishes that anchor's propagation (AnchorPropagation):
// - Before the first valid anchor nothing is published.
// - While the smoother gives the anchor, the filter's anchor of an epoch is held back until the
//   smoother's deadline. It is used only if the smoother misses it or has no result. From then on
//   the filter's anchors are used at once, until the smoother is in time again.
// - After a miss the older anchor remains in use: solutions continue, and their sigmas grow.
// - While the IMU is silent (TimeWithoutImu), each new anchor is published as it is, and those
//   without attitude at the time of the newest epoch. So the answer goes on from GNSS alone.
// - When IMU time runs backwards or leaps, everything is dropped. The pending epochs are decided,
//   so that the journal has one decision for each.
// - After a restart nothing is published until there is an anchor that was issued after it. Epochs
//   issued earlier are decided at their deadlines, so that none counts as a miss, but they are not
//   used. The samples are kept, because the next epoch may be older than the command. After a time
//   step everything is dropped.
// - A solution with a number that is not finite is never published: the anchor is dropped, with an
//   event.
class InertialNavigator {
 public:
  // `smoother_mailbox` may be nullptr if no epoch has a smoother deadline. All pointers must
  // outlive the navigator.
  InertialNavigator(const NavigatorConfig& config, TimedMailbox<Anchor>* ekf_mailbox,
                    TimedMailbox<SmootherAnchor>* smoother_mailbox, OutputSink* sink);
  InertialNavigator(const InertialNavigator&) = delete;
  InertialNavigator& operator=(const InertialNavigator&) = delete;

  // Processes one piece of work; it allocates nothing and never throws.
  void process(const InertialWork& work);

  // Returns the source of the solution after the last sample.
  Source source() const { return source_; }
  // These return how many results of the filter and of the smoother missed their deadlines.
  std::uint64_t misses() const { return decisions_.misses(); }
  std::uint64_t smoother_misses() const { return decisions_.smoother_misses(); }

 private:
  void on_sample(const ImuSample& sample);
  void on_epoch(const EpochIssued& epoch);
  void on_restart(const Restart& restart);
  void on_time_without_imu(GpsTime time);
  // Decisions.
  void decide_due_epochs(GpsTime now);
  void decide(PendingEpoch* epoch, GpsTime now, bool usable);
  void decide_filter(PendingEpoch* epoch, GpsTime now, bool usable);
  void decide_smoother(PendingEpoch* epoch, GpsTime now, bool usable);
  bool commit(const Anchor& anchor, Source source, GpsTime now);
  void report_jump(const Eigen::Vector3d& old_p_e, const PvaCovariance& old_covariance,
                   GpsTime now);
  void clear_anchor();
  void start_over(GpsTime now);
  void drop_anchor(GpsTime now);
  // Publication.
  Source source_at(GpsTime now) const;
  void publish_newest(GpsTime now);
  bool publication_due(GpsTime time);
  void publish(GpsTime time);

  OutputSink* sink_;
  EventSource events_;
  std::int64_t solution_period_ns_;
  std::int64_t ins_only_after_ns_;  // without GNSS for longer the source is kInsOnly
  PendingDecisions decisions_;
  AnchorPropagation propagation_;
  Source anchor_source_ = Source::kEkf;
  GpsTime imu_time_;        // end of the last sample
  GpsTime data_time_;       // the same or, if it is later, the last TimeWithoutImu
  GpsTime last_gnss_time_;  // time of the last anchor that used GNSS
  GpsTime next_solution_due_;
  GpsTime last_solution_time_;
  double pending_jump_m_ = 0.0;  // largest jump since the last published solution
  Source source_ = Source::kNone;
  std::uint64_t next_solution_ = 1;
};

}  // namespace leonav
