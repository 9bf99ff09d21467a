// The InputMonitor finds inputs that fall silent, are rejected, get lost or have gaps.
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "core/navigator/interface/navigator_config.h"
#include "daemon/health/internal/findings.h"
#include "daemon/health/internal/growth_since_look.h"
#include "daemon/health/internal/recent_faults.h"
#include "daemon/health/internal/recent_growth.h"
#include "daemon/health/internal/sign_of_life.h"
#include "daemon/threads/counters.h"

namespace leonav {

class InputMonitor {
 public:
  InputMonitor(const EngineCounters* counters, const NavigatorConfig& config);

  // Once a second; valid until the next call.
  std::span<const Finding> look(double now_s);

  // Why no epoch gets to the filter; "": they do, or the filter waits for the first one since it
  // has started over. Valid until the next call.
  std::string_view why_no_epoch(bool none_since_start);
  // Whether an input that the answer needs does not come any more. Messages that are refused are no
  // silence.
  bool is_silent() const;
  // Whether an IMU is expected and no sample of it has been accepted for a second.
  bool lacks_imu() const { return expects_imu_ && imu_.used.is_late(); }

 private:
  // An input by which the answer lives.
  struct Stream {
    explicit Stream(double late_after_s) : used(late_after_s), any(late_after_s) {}
    SignOfLife used, any;  // accepted by the Sequencer; usable or not
  };
  // What became of the messages of an input channel over the last looks.
  struct Rates {
    RecentGrowth received, accepted, refused;
  };

  void look_at_shares();
  void look_at_stream(const Gauge& accepted, double now_s, Channel channel, HealthReason reason,
                      Stream* stream);
  void append_fault(Channel channel);
  // Valid until the next call.
  std::string_view with_fault(std::string_view text, Channel channel);
  bool are_clocks_apart() const;
  // With the fault of the epochs, and the remedy where the clocks are apart. Valid until the next
  // call.
  std::string_view with_clocks(std::string_view text);

  const EngineCounters* counters_;
  bool expects_imu_, uses_odometer_;
  Stream imu_, gnss_, odometer_;
  std::array<Rates, kInputChannels.size()> rates_;
  RecentFaults faults_;
  GrowthSinceLook lost_, imu_gaps_;
  std::int64_t epochs_without_imu_at_last_use_ = 0;  // of the IMU
  std::string detail_;                               // of the reason that is looked at
  Findings found_;
};

}  // namespace leonav
