// The HealthMonitor evaluates once a second whether the daemon works, and why not.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/engine/engine.h"
#include "daemon/health/active_reasons.h"
#include "daemon/health/internal/recent_faults.h"
#include "daemon/health/internal/recent_growth.h"
#include "daemon/health/journal_health.h"
#include "daemon/health/keep_rule.h"

namespace leonav {

class HealthMessage;

// It runs in `main` and reads the engine's counters; their differences between two calls are what
// happened since. docs/operations/health.md has every reason.
class HealthMonitor {
 public:
  HealthMonitor(Engine* engine, const NavigatorConfig& config);
  ~HealthMonitor();
  HealthMonitor(const HealthMonitor&) = delete;
  HealthMonitor& operator=(const HealthMonitor&) = delete;

  // The encoded message; valid until the next call. `now_s`: of a clock that never goes back, 0 at
  // construction. Silence is measured with it and not with data time, which stands still when all
  // inputs end. `stalled_threads`: by the ThreadMonitor.
  std::span<const std::uint8_t> next(std::string_view stalled_threads = {}) {
    return next(uptime_s(), stalled_threads);
  }
  std::span<const std::uint8_t> next(double now_s, std::string_view stalled_threads = {});
  // The status and its reasons at the last call.
  HealthStatus status() const { return reasons_.status(); }
  const std::string& why() { return reasons_.text(); }
  // Inputs that break a convention, with the remedies; part of why(). Empty: none.
  const std::string& suspicions() const { return suspicions_; }
  // Whether there was an answer at the last call; part of status().
  Fault fault() const { return fault_; }
  const JournalHealth& journal() const { return journal_; }

 private:
  // A stream is alive while a number of it changes.
  struct Stream {
    double degraded_after_s, fault_after_s;
    std::int64_t number = 0;
    double last_s = 0.0;  // when the number was last seen to change
    bool is_late = false, has_ended = false;

    void look(std::int64_t now_number, double now_s);
  };
  // What became of the messages of an input channel over the last looks.
  struct InputRates {
    RecentGrowth received, accepted, refused;
  };

  double uptime_s() const { return static_cast<double>(uptime_.nanoseconds()) * 1e-9; }
  void judge_answer(double now_s);
  void judge_levels();
  void judge_inputs(double now_s);
  void judge_stream(std::int64_t number, double now_s, Channel channel, HealthReason reason,
                    Stream* stream, Stream* any);
  void judge_starts();
  void judge_conventions();
  void judge_measurements();
  void judge_estimator();
  void judge_time();
  void judge_disk(double now_s);
  Fault why_no_answer() const;
  std::int64_t events(EventKind kind) const;
  void raise_if_grown(HealthReason reason, std::int64_t count, bool counts = true);
  // These are valid until the next one.
  std::string_view why_no_solution();
  std::string_view why_no_epoch();
  std::string_view with_fault(std::string_view text, Channel channel);
  void append_fault(Channel channel);

  Engine* engine_;
  AlignmentConfig alignment_;
  double horizontal_alert_limit_m_, vertical_alert_limit_m_;  // 0: none
  bool expects_imu_, uses_odometer_;
  Stream imu_, gnss_, odometer_, solution_;
  Stream any_imu_, any_gnss_, any_odometer_;  // usable or not
  JournalHealth journal_;
  Fault fault_ = Fault::kNone;
  Stopwatch uptime_;
  std::uint64_t sequence_ = 0;
  std::array<InputRates, kInputChannels.size()> inputs_;
  RecentFaults faults_;
  RecentGrowth measurements_, contradicting_;
  RecentGrowth satellite_faults_{600};
  std::int64_t starts_ = 0;                                   // of the filter
  std::int64_t epochs_at_start_ = 0, received_at_start_ = 0;  // accepted and received until then
  int answering_looks_ = 0;        // in a row with an answer of filter or smoother
  std::int64_t most_precise_ = 0;  // satellites by precise states since there were none
  std::array<std::int64_t, kHealthReasonCount> last_counts_{};
  ActiveReasons reasons_;
  std::string suspicions_;
  // The values that suspicions_ tells, in thousandths.
  std::array<std::optional<std::int64_t>, kConventionCount> suspected_;
  std::string detail_;  // of the reason that is judged
  std::unique_ptr<HealthMessage> message_;
};

}  // namespace leonav
