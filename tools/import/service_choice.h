// The ServiceChoice decides which of several correction services is used for one satellite system.
#pragma once
#include <compare>
#include <cstdint>
#include <map>
#include <optional>

#include "core/base/gps_time.h"
#include "drivers/ssr/ssr_correction.h"

namespace leonav {

// A service of one stream, for a stream may bring several. The lesser one is preferred: that of the
// stream listed first, and of one stream SSR before HAS before PPP-B2b.
struct ServiceId {
  std::size_t stream = 0;
  SsrService service = SsrService::kRtcm;
  friend auto operator<=>(const ServiceId&, const ServiceId&) = default;
};

struct ServiceChoiceOptions {
  // So long without a usable state of the service in use, until another one takes its place, s.
  double fallback_s = 30.0;
  // So long must a preferred service have given usable states without such a pause, until it is
  // used again, s.
  double return_s = 60.0;
};

// Two services have clocks and biases of their own, which must not be mixed among the satellites of
// a system. The choice depends on the times of the states alone, so that a recording gives the same
// choice again.
class ServiceChoice {
 public:
  explicit ServiceChoice(const ServiceChoiceOptions& options) : options_(options) {}

  struct Change {
    std::optional<ServiceId> from;  // empty: none was in use
    ServiceId to;
    double pause_s = 0.0;  // since the last usable state of `from`
  };
  // Takes that a service has given usable states at `now`. The first service to do so is used. One
  // in use that pauses gives way to the most preferred one that does not; while it does not pause,
  // to a preferred one that has come back. Returns the change that follows.
  std::optional<Change> note(const ServiceId& id, GpsTime now);

  std::optional<ServiceId> in_use() const { return in_use_; }

 private:
  struct Times {
    GpsTime since, last;  // of usable states without a pause
  };
  bool is_live(const Times& times, GpsTime now) const;

  ServiceChoiceOptions options_;
  std::map<ServiceId, Times> times_;
  std::optional<ServiceId> in_use_;
};

}  // namespace leonav
