// Slips put into the recorded station's log, and what leonav-replay then tells of the arcs: the
// whole way from the message to the report, with the filter's own predictions and sigmas.
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "scenario/recorded_runs.h"
#include "support/slips/slip_table.h"

namespace leonav::test {
namespace {

constexpr double kMask_deg = 15.0;
constexpr std::size_t kApart = 3;  // epochs, between two slips of a satellite

long centiseconds(double tow_s) { return std::lround(100.0 * tow_s); }

std::map<std::string, std::string> fields_of(const std::vector<std::string>& names,
                                             const std::string& line) {
  std::map<std::string, std::string> fields;
  std::istringstream text(line);
  std::string field;
  for (std::size_t i = 0; i < names.size() && std::getline(text, field, ','); ++i)
    fields[names[i]] = field;
  return fields;
}

template <typename Use>
void for_each_row(const std::string& path, Use use) {
  std::istringstream file(text_of(path));
  std::string line, name;
  REQUIRE(std::getline(file, line));
  std::vector<std::string> names;
  std::istringstream header(line);
  while (std::getline(header, name, ',')) names.push_back(name);
  while (std::getline(file, line)) use(fields_of(names, line));
}

using Place = std::pair<std::size_t, SatelliteId>;  // epoch, satellite

struct Arc {
  bool started = false;
  bool told = false;  // by the receiver, or by its absence at the epoch before
  bool had_one = false;
};

struct ReplayedArcs {
  std::map<Place, Arc> arcs;  // of used satellites above the mask
  std::map<Place, std::string> signals;
};

using Epochs = std::map<long, std::size_t>;  // by time of week

ReplayedArcs replay(const TemporaryFile& place, const std::string& log, const std::string& options,
                    const Epochs& epochs) {
  const std::string out = place.beside("result");
  const ProgramRun run = run_program("leonav-replay", options + " --out " + out + " " + log);
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  ReplayedArcs result;
  const auto place_of_row = [&](std::map<std::string, std::string>& row) {
    const auto satellite = satellite_from_string(row["satellite"]);
    REQUIRE(satellite);
    return Place{epochs.at(centiseconds(std::stod(row["gps_tow_s"]))), *satellite};
  };
  for_each_row(out + "/satellites.csv", [&](std::map<std::string, std::string> row) {
    if (row["reason"] != "used" || row["arc"] == "0" || row["elevation_deg"].empty() ||
        std::stod(row["elevation_deg"]) < kMask_deg)
      return;
    const std::string causes = row["arc_causes"];
    Arc arc{row["arc_started"] == "1", false, !causes.empty()};
    for (const char* cause : {"signal_changed", "loss_of_lock", "lock_time"})
      arc.told = arc.told || causes.find(cause) != std::string::npos;
    const Place at = place_of_row(row);
    arc.told = arc.told || (causes.find("gap") != std::string::npos && at.first > 0 &&
                            result.arcs.count({at.first - 1, at.second}) == 0);
    result.arcs[at] = arc;
  });
  for_each_row(out + "/measurements.csv", [&](std::map<std::string, std::string> row) {
    if (row["observable"] == "carrier") result.signals[place_of_row(row)] = row["signals"];
  });
  return result;
}

template <typename Use>
void for_each_epoch(const std::string& log, Use use) {
  EventLogReader reader(log);
  Decoder decoder;
  LogEvent event;
  while (reader.next(&event)) {
    RawEpoch raw;
    std::uint64_t sequence = 0;
    const bool is_epoch = event.channel == "LEONAV_GNSS_EPOCH";
    if (is_epoch) {
      const DecodeResult result = decoder.decode(event.data, &raw);
      REQUIRE(result.fault == InputFault::kNone);
      sequence = result.sequence;
    }
    use(event, is_epoch ? &raw : nullptr, sequence);
  }
}

Epochs epochs_of(const std::string& log) {
  Epochs epochs;
  for_each_epoch(log, [&](const LogEvent&, RawEpoch* raw, std::uint64_t) {
    if (raw != nullptr) epochs.insert({centiseconds(raw->time.tow_s()), epochs.size()});
  });
  return epochs;
}

// The log with the carriers' counts moved from each slip on, on all signals of its bands.
void write_with_slips(const std::string& log, const std::string& to, const Epochs& epochs,
                      const std::vector<Injection>& slips, const ReplayedArcs& clean) {
  std::map<Place, Injection> by_place;
  for (const Injection& slip : slips) by_place[{slip.epoch, slip.satellite}] = slip;
  std::map<std::pair<SatelliteId, char>, double> cycles;
  EventLogWriter writer(to);
  Encoder encoder;
  for_each_epoch(log, [&](const LogEvent& event, RawEpoch* raw, std::uint64_t sequence) {
    if (raw == nullptr) {
      REQUIRE(writer.write(event.timestamp_us, event.channel, event.data));
      return;
    }
    const std::size_t k = epochs.at(centiseconds(raw->time.tow_s()));
    for (const auto& [place, slip] : by_place) {
      if (place.first != k) continue;
      const std::string& signals = clean.signals.at(place);  // "1C" or "1C+2W"
      cycles[{place.second, signals[0]}] += slip.first;
      if (signals.size() > 3) cycles[{place.second, signals[3]}] += slip.second;
    }
    for (SignalObservation& o : raw->observations) {
      const auto offset = cycles.find({o.satellite, o.code.band});
      if (offset != cycles.end()) o.carrier_cycles += offset->second;
    }
    REQUIRE(writer.write(event.timestamp_us, event.channel, encoder.encode(*raw, sequence)));
  });
  REQUIRE(writer.flush());
}

// Arcs begun though nothing slipped and the receiver told nothing; an arc that nothing tested
// counts.
long false_ends(const ReplayedArcs& run, const std::set<Place>& slipped) {
  long count = 0;
  for (const auto& [place, arc] : run.arcs) {
    bool near = false;
    for (std::size_t back = 0; back < kApart && back <= place.first; ++back)
      near = near || slipped.count({place.first - back, place.second}) > 0;
    count += arc.started && arc.had_one && !arc.told && !near ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("slips in the recorded station's log are found by the program as a whole",
          "[cycle_slip]") {
  if (!programs() || !have_shared_data("station/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "station"), slipped_log = place.beside("slipped.lcmlog");
  const Epochs epochs = epochs_of(log);
  const std::string systems = " --set gnss.systems=[gps,galileo,beidou]";
  for (const std::string& motion : {std::string(), free_to_move()}) {
    const std::string options = config("station") + systems + motion;
    const ReplayedArcs clean = replay(place, log, options, epochs);
    std::vector<SlipRun::Going> going;
    for (const auto& [at, arc] : clean.arcs) {
      const auto signals = clean.signals.find(at);
      if (arc.started || signals == clean.signals.end()) continue;
      going.push_back({at.first, at.second, signals->second.size() > 3});
    }
    long injected = 0, found = 0, one_frequency = 0, found_false = 0, satellite_epochs = 0;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const std::vector<Injection> slips = draw_injections(going, 0.06, kApart, seed);
      write_with_slips(log, slipped_log, epochs, slips, clean);
      const ReplayedArcs run = replay(place, slipped_log, options, epochs);
      std::set<Place> slipped;
      for (const Injection& slip : slips) {
        const Place at{slip.epoch, slip.satellite};
        slipped.insert(at);
        const auto arc = run.arcs.find(at);
        const bool at_once = arc != run.arcs.end() && arc->second.started;
        ++injected;
        found += at_once ? 1 : 0;
        one_frequency += clean.signals.at(at).size() <= 3 ? 1 : 0;
        if (!at_once)
          std::printf("  missed %s %d/%d at epoch %zu\n", to_string(slip.satellite).c_str(),
                      slip.first, slip.second, slip.epoch);
      }
      found_false += false_ends(run, slipped);
      satellite_epochs += static_cast<long>(run.arcs.size() - slips.size());
    }
    const long clean_false = false_ends(clean, {});
    const auto clean_epochs = static_cast<double>(clean.arcs.size());
    std::printf(
        "station, %s: %ld slips (%ld on one frequency), at once %.2f %%; false per 1000: %.2f, "
        "beside slips %.2f\n",
        motion.empty() ? "standing" : "free to move", injected, one_frequency,
        100.0 * static_cast<double>(found) / static_cast<double>(injected),
        1e3 * static_cast<double>(clean_false) / clean_epochs,
        1e3 * static_cast<double>(found_false) / static_cast<double>(satellite_epochs));
    CHECK(injected > 1500);
    CHECK(one_frequency > 200);
    CHECK(static_cast<double>(found) >= 0.995 * static_cast<double>(injected));
    CHECK(static_cast<double>(clean_false) <= 1e-3 * clean_epochs);
    CHECK(static_cast<double>(found_false) <= 1e-3 * static_cast<double>(satellite_epochs));
  }
}

}  // namespace leonav::test
