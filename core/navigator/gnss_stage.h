// Raw epoch -> measurements -> EKF -> anchor and report.
#pragma once
#include <cstdint>

#include "core/ekf/ekf.h"
#include "core/gnss/satellite_catalog.h"
#include "core/ins/alignment.h"
#include "core/navigator/navigator_config.h"
#include "core/navigator/stage_work.h"
#include "core/navigator/timed_mailbox.h"

namespace leonav {

class GnssStage {
 public:
  GnssStage(const NavigatorConfig& config, TimedMailbox<EkfUpdate>* ekf_mailbox, OutputSink* sink);

  // Allocates nothing, never throws. For an epoch: preprocess, predict over the block, update,
  // align if still needed, deliver to the mailbox, report. Without IMU (constant-velocity model) it
  // also publishes the solution itself, as there is no inertial tick to do so.
  void process(const GnssWork& work);

  const Ekf& ekf() const { return ekf_; }
  const SatelliteCatalog& catalog() const { return catalog_; }

 private:
  void process_epoch(const EpochWork& work);

  NavigatorConfig config_;
  TimedMailbox<EkfUpdate>* mailbox_;
  OutputSink* sink_;
  SatelliteCatalog catalog_;
  Ekf ekf_;
  Alignment alignment_;
  std::unique_ptr<MeasurementEpoch> measurements_;
  std::unique_ptr<EpochReport> report_;
  std::uint64_t next_report_ = 1, next_solution_ = 1, next_event_ = 1;
  int suspect_epochs_ = 0;
};

}  // namespace leonav
