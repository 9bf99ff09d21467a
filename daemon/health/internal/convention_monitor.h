// The ConventionMonitor finds inputs that break a convention.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "daemon/health/internal/findings.h"
#include "daemon/threads/counters.h"

namespace leonav {

// A mistake in the configuration or in what feeds the daemon. The reason stays until the mistake is
// mended and the daemon is started again. What the Sequencer finds it finds again each minute while
// it lasts, as stamps of a receiver that does not know the leap seconds yet: that stays until it
// has not been found for two minutes. A time step of the inputs ends the mistakes of stamps: where
// one is still there, the stages find it again.
class ConventionMonitor {
 public:
  explicit ConventionMonitor(const EngineCounters* counters) : counters_(counters) {}

  // Once a second, with a clock that never goes back; valid until the next call.
  std::span<const Finding> look(double now_s);
  // Each with its remedy; empty: none.
  const std::string& suspicions() const { return suspicions_; }

 private:
  // What a stage suspects.
  struct Suspicion {
    bool is_active = false;
    std::int64_t events = 0;
    double last_s = 0.0;  // of the last event
  };
  // Of one convention.
  struct Suspected {
    Suspicion once, lasting;
    std::int64_t milli = 0;  // the value when it became active, in thousandths

    bool is_active() const { return once.is_active || lasting.is_active; }
  };

  static void look_at(const ConventionGauge& gauge, bool lasts, double now_s, Suspicion* one);

  const EngineCounters* counters_;
  std::string suspicions_;
  std::array<Suspected, kConventionCount> suspected_;
  Findings found_;
};

}  // namespace leonav
