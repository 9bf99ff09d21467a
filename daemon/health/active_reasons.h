// ActiveReasons holds the reasons that are the case, or were a moment ago, as one status and text.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "daemon/health/health_reason.h"

namespace leonav {

// begin(), then raise() for each reason that is the case, once a second. A reason stays for its
// hold after it was last raised, so that a status that comes and goes does not flap. The text names
// those of the worst status first. Memory is taken at construction, and again only where a text is
// longer than any before.
class ActiveReasons {
 public:
  ActiveReasons();

  // `now_s`: of a clock that never goes back.
  void begin(double now_s) { now_s_ = now_s; }
  // `detail`: what tells this case from others of the same reason. It must not change while the
  // case does not: no ages, no counts.
  void raise(HealthReason reason, std::string_view detail = {});

  HealthStatus status() const;
  // "" if OK. Sentences "text (detail): remedy", with "; " between them. Valid until the next call.
  const std::string& text();

 private:
  struct Case {
    bool was_raised = false;
    double last_s = 0.0;
    std::string detail;
  };
  bool is_active(const HealthReasonEntry& entry) const;

  double now_s_ = 0.0;
  std::array<Case, kHealthReasonCount> cases_;
  std::string text_;
};

}  // namespace leonav
