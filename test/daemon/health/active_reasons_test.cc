// How long reasons stay, and in which order they are named.
#include "daemon/health/active_reasons.h"

#include <set>
#include <string>

#include "daemon/text/convention_text.h"
#include "daemon/text/reset_text.h"
#include "support/catch.h"

using namespace leonav;

TEST_CASE("a reason stays for its hold and the worst one decides") {
  ActiveReasons reasons;
  reasons.begin(1.0);
  CHECK(reasons.status() == HealthStatus::kOk);
  CHECK(reasons.text().empty());
  reasons.raise(HealthReason::kDeadlineMissed);
  reasons.raise(HealthReason::kNoSolutionYet, "no GNSS has come: look at its sender and lcm.url");
  CHECK(reasons.status() == HealthStatus::kFault);
  CHECK(reasons.text() ==
        "no solution yet (no GNSS has come: look at its sender and lcm.url); deadline missed: look "
        "at the machine's load");
  reasons.begin(2.0);
  CHECK(reasons.status() == HealthStatus::kDegraded);
  CHECK(reasons.text() == "deadline missed: look at the machine's load");
  reasons.begin(6.0);
  CHECK(reasons.status() == HealthStatus::kDegraded);
  reasons.begin(6.5);
  CHECK(reasons.status() == HealthStatus::kOk);
  // Raised again within its hold it goes on, without another text in between.
  for (double now_s = 10.0; now_s < 30.0; now_s += 1.0) {
    reasons.begin(now_s);
    if (static_cast<int>(now_s) % 4 == 2) reasons.raise(HealthReason::kDeadlineMissed);
    CHECK(reasons.text() == "deadline missed: look at the machine's load");
  }
}

TEST_CASE("every reason has a sentence of its own, and what to do or a detail that says it") {
  std::set<std::string_view> texts;
  for (const HealthReasonEntry& entry : health_reasons()) {
    CHECK(texts.insert(entry.text).second);
    CHECK(entry.status != HealthStatus::kOk);
    for (const std::string_view part : {entry.text, entry.remedy})
      CHECK(part.find(';') == std::string_view::npos);  // stands between reasons
    CHECK(entry_of(entry.reason).text == entry.text);
  }
  CHECK(texts.size() == kHealthReasonCount);
}

TEST_CASE("what stands between reasons is in no sentence that a reason has as its detail") {
  for (std::size_t i = 0; i < kConventionCount; ++i)
    for (const double value : {-18.0, 18.0})
      CHECK(convention_text(static_cast<Convention>(i), value).find(';') == std::string::npos);
  for (int cause = 0; cause <= static_cast<int>(ResetCause::kImuGap); ++cause)
    CHECK(reset_text(static_cast<ResetCause>(cause)).find(';') == std::string_view::npos);
}
