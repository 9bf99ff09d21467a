#include "core/gnss/satellite_catalog.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/capacity.h"
#include "core/gnss/node_table.h"
#include "core/gnss/precise_orbit.h"

namespace leonav {
namespace {

struct StoredEphemeris {
  Ephemeris ephemeris;
  std::uint64_t arrival = 0;
};

struct Track {
  boost::container::static_vector<StoredEphemeris, kMaxEphemeridesPerSatellite> ephemerides;
  NodeTable<OrbitNode, kMaxOrbitNodes> orbit;
  NodeTable<ClockNode, kMaxClockNodes> clock;  // of clock files
};

bool is_same_issue(const Ephemeris& a, const Ephemeris& b) {
  return a.message == b.message && a.toe == b.toe && a.issue == b.issue;
}

// Galileo SVH as in RINEX: DVS and HS of E1-B, E5a, E5b in bits 0-8. Any of them set counts, also
// "working without guarantee"; the same for GPS's six bits and BeiDou's one.
bool is_healthy(const Ephemeris& ephemeris) { return ephemeris.health == 0; }

bool is_preferred_message(const Ephemeris& ephemeris, const CatalogOptions& options) {
  if (ephemeris.satellite.system != System::kGalileo) return true;
  return (ephemeris.message == NavigationMessage::kGalileoFnav) == options.galileo_prefers_fnav;
}

double max_age_s(System system, const CatalogOptions& options) {
  switch (system) {
    case System::kGps:
      return options.max_age_gps_s;
    case System::kGalileo:
      return options.max_age_galileo_s;
    case System::kBeidou:
      return options.max_age_beidou_s;
    case System::kLeo:
      return options.max_age_leo_s;
  }
  return 0.0;
}

// Whether `a` serves `time` better than `b`: nearer toe, preferred message, later transmission,
// later arrival. Galileo sends each batch of elements in both messages, with the same toe and
// IODnav and the clock of each message's pair (OS-SIS-ICD 5.1.3, 5.1.9), and the group delays make
// either clock serve any signal: which message it is matters less than an older batch.
bool is_better(const StoredEphemeris& a, const StoredEphemeris& b, GpsTime time,
               const CatalogOptions& options) {
  const double age_a = std::abs(seconds_between(time, a.ephemeris.toe));
  const double age_b = std::abs(seconds_between(time, b.ephemeris.toe));
  if (age_a != age_b) return age_a < age_b;
  const bool preferred_a = is_preferred_message(a.ephemeris, options);
  const bool preferred_b = is_preferred_message(b.ephemeris, options);
  if (preferred_a != preferred_b) return preferred_a;
  if (a.ephemeris.transmission_time != b.ephemeris.transmission_time) {
    return a.ephemeris.transmission_time > b.ephemeris.transmission_time;
  }
  return a.arrival > b.arrival;
}

bool is_in_age(const Ephemeris& ephemeris, GpsTime time, const CatalogOptions& options) {
  return std::abs(seconds_between(time, ephemeris.toe)) <=
         max_age_s(ephemeris.satellite.system, options);
}

const Ephemeris* best_ephemeris(const Track& track, GpsTime time, const CatalogOptions& options) {
  const StoredEphemeris* best = nullptr;
  for (const StoredEphemeris& stored : track.ephemerides) {
    if (!is_in_age(stored.ephemeris, time, options)) continue;
    if (best == nullptr || is_better(stored, *best, time, options)) best = &stored;
  }
  return best != nullptr ? &best->ephemeris : nullptr;
}

// Health as last transmitted up to `time`: an older issue may be nearer in toe and not yet know.
bool newest_is_unhealthy(const Track& track, GpsTime time, const CatalogOptions& options) {
  const Ephemeris* newest = nullptr;
  for (const StoredEphemeris& stored : track.ephemerides) {
    const Ephemeris& e = stored.ephemeris;
    if (!e.transmission_time.is_set() || e.transmission_time > time) continue;
    if (!is_in_age(e, time, options)) continue;
    if (newest == nullptr || e.transmission_time >= newest->transmission_time) newest = &e;
  }
  return newest != nullptr && !is_healthy(*newest);
}

bool is_sane_node(const PreciseState& state) {
  if (!is_valid(state.satellite) || state.time.nanoseconds() <= 0) return false;
  const bool has_clock = std::abs(state.clock_s) < 0.1;  // false for NaN
  if (state.is_clock_only()) return has_clock;
  const double radius = state.p_e.norm();
  if (!(radius > 6.4e6 && radius < 1e8)) return false;  // false for NaN
  return has_clock || std::isnan(state.clock_s);
}

// What SatelliteState::issue says: the kind of product in the two highest bits. Broadcast: message,
// time of ephemeris (it repeats after 4.5 h, twice the longest life of a set) and issue.
enum class IssueKind : std::uint32_t { kBroadcast = 1, kPrecise = 2, kPreciseWithClocks = 3 };

std::uint32_t issue_of(IssueKind kind) { return static_cast<std::uint32_t>(kind) << 30; }

std::uint32_t issue_of(const Ephemeris& e) {
  constexpr std::int64_t kToeUnit = 8 * kNanosecondsPerSecond;  // the finest that a message has
  const auto toe = static_cast<std::uint32_t>(e.toe.nanoseconds() / kToeUnit % 2048);
  return issue_of(IssueKind::kBroadcast) | static_cast<std::uint32_t>(e.message) << 27 | toe << 16 |
         e.issue;
}

// Orbit from the orbit's nodes, clock from the finer clocks where they are.
bool find_precise(const Track& track, System system, GpsTime time, const CatalogOptions& options,
                  SatelliteState* state) {
  PreciseClock clock;
  const bool fine = interpolate_clock(track.clock.data(), track.clock.size(), time,
                                      options.max_clock_gap_s, system, &clock);
  if (!precise_state(track.orbit.data(), track.orbit.size(), time, options.max_orbit_gap_s, system,
                     fine ? &clock : nullptr, state)) {
    return false;
  }
  state->issue = issue_of(fine ? IssueKind::kPreciseWithClocks : IssueKind::kPrecise);
  state->clock_of_file = fine;
  return true;
}

}  // namespace

struct SatelliteCatalog::Storage {
  CatalogOptions options;
  KlobucharModel klobuchar;
  std::uint64_t arrivals = 0;
  std::array<Track, kMaxEphemerisSatellites> tracks;
};

SatelliteCatalog::SatelliteCatalog(const CatalogOptions& options)
    : storage_(std::make_unique<Storage>()) {
  storage_->options = options;
}
SatelliteCatalog::~SatelliteCatalog() = default;
SatelliteCatalog::SatelliteCatalog(SatelliteCatalog&&) noexcept = default;
SatelliteCatalog& SatelliteCatalog::operator=(SatelliteCatalog&&) noexcept = default;

bool SatelliteCatalog::add(const Ephemeris& ephemeris) {
  if (!is_sane(ephemeris)) return false;
  auto& stored = storage_->tracks[place_of(ephemeris.satellite)].ephemerides;
  auto place = std::find_if(stored.begin(), stored.end(), [&](const StoredEphemeris& s) {
    return is_same_issue(s.ephemeris, ephemeris);
  });
  if (place == stored.end() && stored.size() < stored.capacity()) {
    stored.emplace_back();
    place = stored.end() - 1;
  }
  if (place == stored.end()) {
    place = std::min_element(
        stored.begin(), stored.end(),
        [](const StoredEphemeris& a, const StoredEphemeris& b) { return a.arrival < b.arrival; });
  }
  *place = {ephemeris, ++storage_->arrivals};
  return true;
}

bool SatelliteCatalog::add(const PreciseState& state) {
  if (!is_sane_node(state)) return false;
  Track& track = storage_->tracks[place_of(state.satellite)];
  const std::uint64_t arrival = ++storage_->arrivals;
  if (state.is_clock_only()) {
    track.clock.insert({state.time, state.clock_s, state.clock_event, state.clock_predicted},
                       arrival);
  } else {
    track.orbit.insert({state.time, state.p_e, state.clock_s, state.clock_event, state.maneuver,
                        state.clock_predicted, state.orbit_predicted},
                       arrival);
  }
  return true;
}

void SatelliteCatalog::set_klobuchar(const KlobucharModel& model) { storage_->klobuchar = model; }
const KlobucharModel& SatelliteCatalog::klobuchar() const { return storage_->klobuchar; }

LookupStatus SatelliteCatalog::state_at(SatelliteId satellite, GpsTime time, SatelliteState* state,
                                        const Ephemeris** ephemeris) const {
  if (ephemeris != nullptr) *ephemeris = nullptr;
  if (!is_valid(satellite) || time.nanoseconds() <= 0) return LookupStatus::kNoEphemeris;
  const CatalogOptions& options = storage_->options;
  const Track& track = storage_->tracks[place_of(satellite)];
  if (track.ephemerides.empty() && track.orbit.empty()) return LookupStatus::kNoEphemeris;

  const Ephemeris* best = best_ephemeris(track, time, options);
  if (best != nullptr && (!is_healthy(*best) || newest_is_unhealthy(track, time, options))) {
    return LookupStatus::kUnhealthy;
  }
  if (options.use_precise && find_precise(track, satellite.system, time, options, state)) {
    return LookupStatus::kOk;
  }
  if (best == nullptr) {
    return track.ephemerides.empty() && !options.use_precise ? LookupStatus::kNoEphemeris
                                                             : LookupStatus::kTooOld;
  }
  *state = broadcast_state(*best, time);
  state->issue = issue_of(*best);
  if (ephemeris != nullptr) *ephemeris = best;
  return LookupStatus::kOk;
}

const Ephemeris* SatelliteCatalog::ephemeris_at(SatelliteId satellite, GpsTime time) const {
  if (!is_valid(satellite) || time.nanoseconds() <= 0) return nullptr;
  return best_ephemeris(storage_->tracks[place_of(satellite)], time, storage_->options);
}

const Ephemeris* SatelliteCatalog::elements_of(SatelliteId satellite, std::uint32_t issue) const {
  if (!is_valid(satellite)) return nullptr;
  for (const StoredEphemeris& stored : storage_->tracks[place_of(satellite)].ephemerides)
    if (issue_of(stored.ephemeris) == issue) return &stored.ephemeris;
  return nullptr;
}

}  // namespace leonav
