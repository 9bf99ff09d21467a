#include "core/navigator/monitors/usability_monitor.h"

#include <vector>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {

TEST_CASE("five epochs in a row without a satellite, all for one reason, are told once") {
  UsabilityMonitor watch;
  const auto add = [&](std::vector<Reason> reasons) {
    std::vector<SatelliteReport> satellites;
    for (const Reason reason : reasons) {
      satellites.emplace_back();
      satellites.back().reason = reason;
    }
    return watch.add(satellites);
  };
  const std::vector<Reason> bad = {Reason::kImplausible, Reason::kLowElevation,
                                   Reason::kImplausible, Reason::kSystemDisabled};
  for (int k = 1; k <= 12; ++k) {
    const auto finding = add(bad);
    CHECK(finding.has_value() == (k == 5));
    if (finding) CHECK(finding->reason == Reason::kImplausible);
    if (finding) CHECK(finding->satellites == 2);
  }
  for (const std::vector<Reason>& between :
       {std::vector<Reason>{Reason::kImplausible, Reason::kLowCn0},
        std::vector<Reason>{Reason::kImplausible, Reason::kUsed},
        std::vector<Reason>{Reason::kDownweighted}, std::vector<Reason>{}}) {
    CHECK_FALSE(add(between));
    for (int k = 1; k <= 5; ++k) CHECK(add(bad).has_value() == (k == 5));
  }
  // Below the mask is where satellites are at times.
  for (int k = 1; k <= 6; ++k) CHECK_FALSE(add({Reason::kLowElevation}));
}

TEST_CASE("a receiver clock 150 ms off is told, one 90 ms off is solved") {
  for (const double clock_ms : {90.0, 150.0}) {
    CAPTURE(clock_ms);
    SyntheticDrive drive = drive_of(20.0, 0.0, false);
    for (RawEpoch& epoch : drive.epochs)
      for (SignalObservation& o : epoch.observations) o.pseudorange_m += clock_ms * 299'792.458;
    const NavigatorConfig config =
        drive_navigator_config(drive.options, MotionModel::kConstantVelocity);
    const RecordingSink sink = run(drive, config);
    const bool lost = clock_ms > 110.0;
    CHECK(sink.count(EventKind::kNoneUsable) == (lost ? 1 : 0));
    CHECK(sink.solutions.empty() == lost);
    for (const Event& event : sink.events) {
      if (event.kind != EventKind::kNoneUsable) continue;
      CHECK(event.code == static_cast<std::uint8_t>(Reason::kImplausible));
      CHECK(event.value >= 5.0);
      CHECK(to_string(event.kind) == "none_usable");
    }
  }
}

}  // namespace leonav::test
