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
  explicit HealthMonitor(Engine* engine, bool expects_imu)
      : engine_(engine), expects_imu_(expects_imu) {}

  // The encoded message; valid until the next call.
  std::span<const std::uint8_t> next();
  // "OK", "DEGRADED" or "FAULT", and why: of the last call.
  const std::string& status() const { return status_; }
  const std::string& why() const { return why_; }

 private:
  void judge();
  void worsen(const char* status, const std::string& reason);

  Engine* engine_;
  bool expects_imu_;
  Stopwatch uptime_;
  std::uint64_t sequence_ = 0;
  std::int64_t last_imu_ = 0, last_misses_ = 0, last_lost_ = 0;
  std::uint64_t last_waits_ = 0;
  std::string status_ = "OK", why_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace leonav
