// The HealthMonitor evaluates once a second whether the daemon works, and why not.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/engine/engine.h"

namespace leonav {

// It runs in `main` and reads the engine's counters; their differences between two calls are what
// happened since.
class HealthMonitor {
 public:
  HealthMonitor(Engine* engine, const NavigatorConfig& config);

  // The encoded message; valid until the next call. `now_s`: of a clock that never goes back, 0 at
  // construction. Silence is measured with it and not with data time, which stands still when all
  // inputs end.
  std::span<const std::uint8_t> next() { return next(uptime_s()); }
  std::span<const std::uint8_t> next(double now_s);
  // "OK", "DEGRADED" or "FAULT", and the reasons, at the last call.
  const std::string& status() const { return status_; }
  const std::string& why() const { return why_; }
  // Inputs that break a convention, with the remedies; part of why(). Empty: none.
  const std::string& suspicions() const { return suspicions_; }

 private:
  // A stream is alive while a number of it changes.
  struct Stream {
    const char* name;
    double degraded_after_s, fault_after_s;
    std::int64_t number = 0;
    double last_s = 0.0;  // when the number was last seen to change
    bool dead = false;    // silent for longer than fault_after_s
  };
  double uptime_s() const { return static_cast<double>(uptime_.nanoseconds()) * 1e-9; }
  void evaluate(double now_s);
  void evaluate_solution(double now_s);
  void evaluate_stream(std::int64_t number, double now_s, Stream* stream);
  void evaluate_levels();
  void evaluate_journal();
  void evaluate_conventions();
  void evaluate_count(std::int64_t count, const char* reason, std::int64_t* last);
  void worsen(const char* status, const std::string& reason);

  Engine* engine_;
  AlignmentConfig alignment_;
  double horizontal_alert_limit_m_, vertical_alert_limit_m_;  // 0: none
  bool expects_imu_, uses_odometer_;
  Stream imu_, gnss_, odometer_, solution_;
  Stopwatch uptime_;
  std::uint64_t sequence_ = 0;
  std::int64_t last_misses_ = 0, last_smoother_misses_ = 0, last_smoother_failures_ = 0,
               last_keyframes_skipped_ = 0, last_lost_ = 0, last_waits_ = 0, last_lost_journal_ = 0,
               last_left_out_ = 0;
  std::string status_ = "OK", why_, suspicions_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace leonav
