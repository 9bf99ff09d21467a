// The daemon's state in one message, once a second.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/engine.h"

namespace leonav {

// Watches an engine from `main`: differences between two calls tell what happened lately.
class HealthMonitor {
 public:
  HealthMonitor(Engine* engine, const NavigatorConfig& config);

  // The encoded message; valid until the next call. `now_s`: of a clock that never goes back, 0 at
  // construction. Silence is judged by it and not by data time, which stands still when all inputs
  // end.
  std::span<const std::uint8_t> next() { return next(uptime_s()); }
  std::span<const std::uint8_t> next(double now_s);
  // "OK", "DEGRADED" or "FAULT", and why: of the last call.
  const std::string& status() const { return status_; }
  const std::string& why() const { return why_; }
  // What does not follow leonav's conventions, with the remedies; part of why(). Empty: nothing.
  const std::string& suspicions() const { return suspicions_; }

 private:
  // Something that should go on, by a number that changes when it does.
  struct Stream {
    const char* name;
    double degraded_after_s, fault_after_s;
    std::int64_t number = 0;
    double last_s = 0.0;  // when the number was last seen to change
    bool dead = false;    // silent for longer than fault_after_s
  };
  double uptime_s() const { return static_cast<double>(uptime_.nanoseconds()) * 1e-9; }
  void judge(double now_s);
  void judge_solution(double now_s);
  void judge_stream(std::int64_t number, double now_s, Stream* stream);
  void judge_conventions();
  void judge_count(std::int64_t count, const char* reason, std::int64_t* last);
  void worsen(const char* status, const std::string& reason);

  Engine* engine_;
  AlignmentConfig alignment_;
  bool expects_imu_, uses_odometer_;
  Stream imu_, gnss_, odometer_, solution_;
  Stopwatch uptime_;
  std::uint64_t sequence_ = 0;
  std::int64_t last_misses_ = 0, last_smoother_misses_ = 0, last_smoother_failures_ = 0,
               last_keyframes_skipped_ = 0, last_lost_ = 0, last_waits_ = 0;
  std::string status_ = "OK", why_, suspicions_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace leonav
