// The recorded station's log with its products late, ended or with holes: what the solution then
// says of itself must stay true. The position is free at every epoch.
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"
#include "scenario/recorded_runs.h"

namespace leonav::test {
namespace {

// Whether an event goes into the changed log now; those held come at the end of the hold.
enum class Fate { kPass, kDrop, kHold };
using Judge = std::function<Fate(const LogEvent& event, int epochs)>;

void rewrite(const std::string& from, const std::string& to, int hold_until, const Judge& judge) {
  EventLogReader reader(from);
  EventLogWriter writer(to);
  std::vector<LogEvent> held;
  LogEvent event;
  int epochs = 0;
  while (reader.next(&event)) {
    if (event.channel == "LEONAV_GNSS_EPOCH" && ++epochs == hold_until) {
      for (const LogEvent& late : held)
        REQUIRE(writer.write(event.timestamp_us, late.channel, late.data));
    }
    const Fate fate = judge(event, epochs);
    if (fate == Fate::kHold) held.push_back(event);
    if (fate == Fate::kPass) REQUIRE(writer.write(event.timestamp_us, event.channel, event.data));
  }
  REQUIRE(writer.flush());
}

struct Outcome {
  double within = 0.0;  // share within three stated sigma
  double worst_late_m = 0.0;
  std::string summary;
};

// `late`: from this time of week on the largest 3D error counts.
Outcome outcome_of(const TemporaryFile& place, const std::string& log, double late_tow_s,
                   const std::string& options = "") {
  const TemporaryFile truth("truth.csv", station_truth());
  const std::string free = config("station") + free_to_move() + options;
  const std::string judge = "--max-truth-gap 1e9 --truth " + truth.path() + " --from 2111:";
  Outcome outcome;
  errors_of(place, log, free, judge + "351600");
  outcome.summary = text_of(place.beside("result") + "/summary.txt");
  outcome.within = number_after(text_of(place.beside("errors.json")), "", "within_three_sigma");
  errors_of(place, log, free, judge + std::to_string(late_tow_s));
  outcome.worst_late_m = number_after(text_of(place.beside("errors.json")), "3d_m", "worst");
  return outcome;
}

bool is_clock_only(const LogEvent& event) {
  static Decoder decoder;
  const auto states = std::make_unique<PreciseStates>();
  if (decoder.decode(event.data, states.get()).fault != InputFault::kNone) return false;
  return !states->empty() && states->front().is_clock_only();
}

bool ready() { return programs() && have_shared_data("station/dataset.yaml"); }

}  // namespace

TEST_CASE("antenna patterns that come 2.5 h late do not leave the solution wrong and sure") {
  if (!ready()) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "station"), late = place.beside("late.lcmlog");
  rewrite(log, late, 300, [](const LogEvent& event, int) {
    return event.channel == "LEONAV_ANTENNA" ? Fate::kHold : Fate::kPass;
  });
  const Outcome outcome = outcome_of(place, late, 358200.0);  // an hour after they came
  std::printf("antennas late: %.2f %% within three sigma, 3D at most %.3f m an hour later\n",
              100.0 * outcome.within, outcome.worst_late_m);
  CHECK(outcome.within > 0.99);
  CHECK(outcome.worst_late_m < 0.1);
}

TEST_CASE("precise products that end leave a solution that knows what broadcast orbits are worth") {
  if (!ready()) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "station"), stopped = place.beside("stopped.lcmlog");
  for (const int last : {100, 200, 280, 400}) {
    rewrite(log, stopped, 0, [last](const LogEvent& event, int epochs) {
      return event.channel == "LEONAV_ORBIT_CLOCK" && epochs >= last ? Fate::kDrop : Fate::kPass;
    });
    for (const std::string systems : {"[gps,galileo]", "[gps]", "[galileo]"}) {
      const Outcome outcome =
          outcome_of(place, stopped, 363600.0, " --set gnss.systems=" + systems);
      std::printf(
          "products end at epoch %d, %s: %.2f %% within three sigma, 3D at most %.3f m in "
          "the last hour\n",
          last, systems.c_str(), 100.0 * outcome.within, outcome.worst_late_m);
      CAPTURE(last, systems);
      CHECK(outcome.within > 0.975);
      CHECK(outcome.summary.find("orbit_fallback") != std::string::npos);
      if (last != 200 || systems != "[gps,galileo]") continue;
      CHECK(outcome.within > 0.99);
      CHECK(outcome.worst_late_m < 1.5);
      CHECK(outcome.summary.find("arcs ended by filter") == std::string::npos);
    }
  }
}

// The error of a satellite's orbit and clock lasts for an hour, however many codes are averaged.
TEST_CASE("broadcast orbits alone, and one frequency: carriers make nobody too sure") {
  if (!ready()) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "station");
  const std::string broadcast = " --set gnss.ephemerides.use_precise=false";
  for (const std::string systems : {"[gps]", "[gps,galileo]", "[gps,galileo,beidou]"}) {
    const Outcome outcome =
        outcome_of(place, log, 363600.0, broadcast + " --set gnss.systems=" + systems);
    std::printf("broadcast orbits, %s: %.2f %% within three sigma\n", systems.c_str(),
                100.0 * outcome.within);
    CHECK(outcome.within > 0.99);
  }
  const Outcome single =
      outcome_of(place, log, 363600.0,
                 " --set gnss.gps.second_bands=[] --set gnss.galileo.second_bands=[]"
                 " --set gnss.code_combination=single_frequency");
  std::printf("one frequency: %.2f %% within three sigma\n", 100.0 * single.within);
  CHECK(single.within > 0.99);
}

TEST_CASE("holes in the clock file are reported") {
  if (!ready()) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "station"), holes = place.beside("holes.lcmlog");
  rewrite(log, holes, 0, [](const LogEvent& event, int epochs) {
    const bool hole = epochs >= 200 && epochs / 20 % 2 != 0;
    return hole && event.channel == "LEONAV_ORBIT_CLOCK" && is_clock_only(event) ? Fate::kDrop
                                                                                 : Fate::kPass;
  });
  const Outcome outcome = outcome_of(place, holes, 363600.0);
  CHECK(outcome.within > 0.99);
  CHECK(outcome.worst_late_m < 0.3);
  CHECK(outcome.summary.find("clock_fallback") != std::string::npos);
  CHECK(outcome.summary.find("clock_return") != std::string::npos);
}

}  // namespace leonav::test
