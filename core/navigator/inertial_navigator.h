// Turns every IMU sample into a published solution, from the newest committed anchor.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/ins/mechanization.h"
#include "core/navigator/navigator_config.h"
#include "core/navigator/stage_work.h"
#include "core/navigator/timed_mailbox.h"

namespace leonav {

class InertialNavigator {
 public:
  InertialNavigator(const NavigatorConfig& config, TimedMailbox<EkfUpdate>* ekf_mailbox,
                    OutputSink* sink);

  // Allocates nothing, never throws.
  void process(const InertialWork& work);

  Source source() const { return source_; }
  std::uint64_t misses() const { return misses_; }

 private:
  void on_sample(const ImuSample& sample);
  void decide_due_epochs(GpsTime now);
  void commit(const EkfUpdate& update);
  void publish(GpsTime now);

  NavigatorConfig config_;
  TimedMailbox<EkfUpdate>* mailbox_;
  OutputSink* sink_;
  boost::circular_buffer<ImuSample> history_;    // since the anchor
  boost::circular_buffer<EpochIssued> waiting_;  // issued, not decided
  Mechanization mechanization_;
  EkfUpdate anchor_;
  Source source_ = Source::kNone;
  std::uint64_t misses_ = 0, next_solution_ = 1, next_decision_ = 1, next_event_ = 1;
};

}  // namespace leonav
