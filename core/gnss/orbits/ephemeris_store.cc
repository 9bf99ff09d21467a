#include "core/gnss/orbits/ephemeris_store.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/capacity.h"
#include "core/base/pooled_lists.h"
#include "core/gnss/orbits/internal/interpolation_table.h"
#include "core/gnss/orbits/precise_orbit.h"

namespace leonav {

double EphemerisConfig::max_age_s(System system) const {
  switch (system) {
    case System::kGps:
      return max_age_gps_s;
    case System::kGalileo:
      return max_age_galileo_s;
    case System::kBeidou:
      return max_age_beidou_s;
    case System::kLeo:
      return max_age_leo_s;
  }
  return 0.0;
}

namespace {

struct StoredEphemeris {
  Ephemeris ephemeris;
  std::uint64_t arrival = 0;
  mutable GpsTime used;
};

using Ephemerides = PooledLists<StoredEphemeris, kMaxEphemerisSatellites,
                                kMaxEphemeridesPerSatellite, kMaxEphemerides>;

// Precise and corrected states.
struct SatelliteProducts {
  InterpolationTable<OrbitNode, kMaxOrbitNodes> orbit;
  InterpolationTable<ClockNode, kMaxClockNodes> clock;  // from clock files
  CorrectedState corrected;                             // time unset: none
  // When these states were compared with the broadcast ones; unset: not since something has come.
  GpsTime compared_at;
  bool orbit_refused = false;  // they differed
};

bool is_same_issue(const Ephemeris& a, const Ephemeris& b) {
  return a.message == b.message && a.toe == b.toe && a.issue == b.issue;
}

// Galileo's health is SVH as in RINEX: DVS and HS of E1-B, E5a, E5b in bits 0-8. Any set bit
// counts, also "working without guarantee"; the same holds for the six bits of GPS and the one of
// BeiDou.
bool is_healthy(const Ephemeris& ephemeris) { return ephemeris.health == 0; }

bool is_preferred_message(const Ephemeris& ephemeris, const EphemerisConfig& options) {
  if (ephemeris.satellite.system != System::kGalileo) return true;
  return (ephemeris.message == NavigationMessage::kGalileoFnav) == options.galileo_prefers_fnav;
}

// Returns whether `a` serves `time` better than `b`: nearer toe, preferred message, later
// transmission, later arrival, in this order. Galileo sends each batch of elements in both
// messages, with the same toe and IODnav and the clock of each message's pair (OS-SIS-ICD 5.1.3,
// 5.1.9). The group delays make either clock serve any signal, so the choice of message matters
// less than the age of the batch.
bool is_better(const StoredEphemeris& a, const StoredEphemeris& b, GpsTime time,
               const EphemerisConfig& options) {
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

bool is_in_age(const Ephemeris& ephemeris, GpsTime time, const EphemerisConfig& options) {
  return std::abs(seconds_between(time, ephemeris.toe)) <=
         options.max_age_s(ephemeris.satellite.system);
}

const Ephemeris* best_ephemeris(const Ephemerides& ephemerides, SatelliteId satellite, GpsTime time,
                                const EphemerisConfig& options) {
  const StoredEphemeris* best = nullptr;
  for (const StoredEphemeris& stored : ephemerides[table_index_of(satellite)]) {
    if (!is_in_age(stored.ephemeris, time, options)) continue;
    if (best == nullptr || is_better(stored, *best, time, options)) best = &stored;
  }
  if (best == nullptr) return nullptr;
  ephemerides.mark_used(*best, time);
  return &best->ephemeris;
}

// The health is the last one transmitted up to `time`: an older issue may be nearer in toe and
// carry an outdated health.
bool newest_is_unhealthy(const Ephemerides& ephemerides, SatelliteId satellite, GpsTime time,
                         const EphemerisConfig& options) {
  const Ephemeris* newest = nullptr;
  for (const StoredEphemeris& stored : ephemerides[table_index_of(satellite)]) {
    const Ephemeris& e = stored.ephemeris;
    if (!e.transmission_time.is_set() || e.transmission_time > time) continue;
    if (!is_in_age(e, time, options)) continue;
    if (newest == nullptr || e.transmission_time >= newest->transmission_time) newest = &e;
  }
  return newest != nullptr && !is_healthy(*newest);
}

// Returns the slot for an ephemeris: that of the same issue, a free one, or that of the satellite's
// that makes room.
StoredEphemeris& slot_for(const Ephemeris& ephemeris, Ephemerides* ephemerides) {
  const std::size_t satellite = table_index_of(ephemeris.satellite);
  const auto stored = (*ephemerides)[satellite];
  const auto same =
      std::find_if(stored.begin(), stored.end(), [&](const StoredEphemeris& candidate) {
        return is_same_issue(candidate.ephemeris, ephemeris);
      });
  if (same != stored.end()) return *same;
  if (!ephemerides->is_full(satellite)) return ephemerides->append(satellite);
  return *std::min_element(stored.begin(), stored.end(),
                           [&](const StoredEphemeris& a, const StoredEphemeris& b) {
                             return ephemerides->makes_room(a, b);
                           });
}

bool is_sane_node(const PreciseState& state) {
  if (!is_valid(state.satellite) || state.time.nanoseconds() <= 0) return false;
  const bool has_clock = std::abs(state.clock_s) < 0.1;  // false for NaN
  if (state.is_clock_only()) return has_clock;
  const double radius = state.p_e.norm();
  if (!(radius > 6.4e6 && radius < 1e8)) return false;  // false for NaN
  return has_clock || std::isnan(state.clock_s);
}

// SatelliteState::issue has the kind of product in its two highest bits. For broadcast elements the
// others are the message, the time of ephemeris (it repeats after 4.5 h, twice the longest life of
// a set) and the issue.
enum class IssueKind : std::uint32_t { kBroadcast = 1, kPrecise = 2, kPreciseWithClocks = 3 };

std::uint32_t issue_of(IssueKind kind) { return static_cast<std::uint32_t>(kind) << 30; }

std::uint32_t issue_of(const Ephemeris& e) {
  constexpr std::int64_t kToeUnit = 8 * kNanosecondsPerSecond;  // the finest that a message has
  const auto toe = static_cast<std::uint32_t>(e.toe.nanoseconds() / kToeUnit % 2048);
  return issue_of(IssueKind::kBroadcast) | static_cast<std::uint32_t>(e.message) << 27 | toe << 16 |
         e.issue;
}

// A correction changes by centimetres from one to the next, also where it refers to new broadcast
// elements: all corrected states have one issue.
bool find_corrected(const SatelliteProducts& products, GpsTime time, const EphemerisConfig& options,
                    SatelliteState* state) {
  const CorrectedState& corrected = products.corrected;
  if (!corrected.time.is_set()) return false;
  if (std::abs(seconds_between(time, corrected.time)) > kLongestCarry_s) return false;
  if (std::abs(seconds_between(time, corrected.corrected_at)) > options.max_age_corrections_s) {
    return false;
  }
  if (std::abs(seconds_between(time, corrected.orbit_corrected_at)) > kLongestOrbitAge_s) {
    return false;
  }
  *state = carried_state(corrected, time);
  state->issue = issue_of(IssueKind::kPrecise) | 1U;
  return true;
}

// The orbit comes from the orbit's nodes, the clock from the finer clock files where they exist.
bool find_precise(const SatelliteProducts& products, System system, GpsTime time,
                  const EphemerisConfig& options, SatelliteState* state) {
  PreciseClock clock;
  const bool fine = interpolate_clock(products.clock.data(), products.clock.size(), time,
                                      options.max_clock_gap_s, system, &clock);
  if (!precise_state(products.orbit.data(), products.orbit.size(), time, options.max_orbit_gap_s,
                     system, fine ? &clock : nullptr, state)) {
    return false;
  }
  state->issue = issue_of(fine ? IssueKind::kPreciseWithClocks : IssueKind::kPrecise);
  state->clock_from_file = fine;
  return true;
}

bool find_any_precise(const SatelliteProducts& products, System system, GpsTime time,
                      const EphemerisConfig& options, SatelliteState* state) {
  return options.use_precise && (find_corrected(products, time, options, state) ||
                                 find_precise(products, system, time, options, state));
}

// Largest difference of good orbits, centre of mass against antenna included. GPS and Galileo up to
// an hour from toe differ by 5.3 m at most, an hour and a half before toe by 13 m
// (docs/validation/orbits.md). It is not measured of BeiDou, whose geosynchronous orbits are known
// less well.
constexpr double kMaxOrbitDifference_m = 10.0;
constexpr double kMaxBeidouDifference_m = 30.0;
constexpr double kMaxComparedAge_s = 3600.0;  // of the broadcast elements
constexpr double kCompareInterval_s = 0.9;    // stamps of epochs at 1 Hz drift with the clock

double max_difference_m(System system) {
  return system == System::kBeidou ? kMaxBeidouDifference_m : kMaxOrbitDifference_m;
}

}  // namespace

struct EphemerisStore::Storage {
  EphemerisConfig options;
  KlobucharModel klobuchar;
  std::uint32_t klobuchar_issue = 0;
  std::uint64_t arrivals = 0;
  Ephemerides ephemerides;
  std::array<SatelliteProducts, kMaxEphemerisSatellites> products_of;
};

EphemerisStore::EphemerisStore(const EphemerisConfig& options)
    : storage_(std::make_unique<Storage>()) {
  storage_->options = options;
}
EphemerisStore::~EphemerisStore() = default;
EphemerisStore::EphemerisStore(EphemerisStore&&) noexcept = default;
EphemerisStore& EphemerisStore::operator=(EphemerisStore&&) noexcept = default;

bool EphemerisStore::add(const Ephemeris& ephemeris) {
  if (!is_sane(ephemeris) || is_for_corrections_alone(ephemeris)) return false;
  StoredEphemeris& slot = slot_for(ephemeris, &storage_->ephemerides);
  // A set that is sent again stays in use.
  const GpsTime used = is_same_issue(slot.ephemeris, ephemeris) ? slot.used : GpsTime();
  slot = {ephemeris, ++storage_->arrivals, used};
  storage_->products_of[table_index_of(ephemeris.satellite)].compared_at = GpsTime();
  return true;
}

bool EphemerisStore::add(const PreciseState& state) {
  if (!is_sane_node(state)) return false;
  SatelliteProducts& products = storage_->products_of[table_index_of(state.satellite)];
  products.compared_at = GpsTime();
  const std::uint64_t arrival = ++storage_->arrivals;
  if (state.is_clock_only()) {
    products.clock.insert({state.time, state.clock_s, state.clock_event, state.clock_predicted},
                          arrival);
  } else {
    products.orbit.insert({state.time, state.p_e, state.clock_s, state.clock_event, state.maneuver,
                           state.clock_predicted, state.orbit_predicted},
                          arrival);
  }
  return true;
}

bool EphemerisStore::add(const CorrectedState& state) {
  if (!is_sane(state)) return false;
  SatelliteProducts& products = storage_->products_of[table_index_of(state.satellite)];
  products.corrected = state;
  products.compared_at = GpsTime();
  return true;
}

void EphemerisStore::set_klobuchar(const KlobucharModel& model) {
  if (model != storage_->klobuchar) ++storage_->klobuchar_issue;
  storage_->klobuchar = model;
}
const KlobucharModel& EphemerisStore::klobuchar() const { return storage_->klobuchar; }
std::uint32_t EphemerisStore::klobuchar_issue() const { return storage_->klobuchar_issue; }

LookupStatus EphemerisStore::state_at(SatelliteId satellite, GpsTime time, SatelliteState* state,
                                      const Ephemeris** ephemeris) const {
  if (ephemeris != nullptr) *ephemeris = nullptr;
  if (!is_valid(satellite) || time.nanoseconds() <= 0) return LookupStatus::kNoEphemeris;
  const EphemerisConfig& options = storage_->options;
  const Ephemerides& ephemerides = storage_->ephemerides;
  const SatelliteProducts& products = storage_->products_of[table_index_of(satellite)];
  const bool has_ephemerides = !ephemerides[table_index_of(satellite)].empty();
  if (!has_ephemerides && products.orbit.empty() && !products.corrected.time.is_set()) {
    return LookupStatus::kNoEphemeris;
  }

  const Ephemeris* best = best_ephemeris(ephemerides, satellite, time, options);
  if (best != nullptr &&
      (!is_healthy(*best) || newest_is_unhealthy(ephemerides, satellite, time, options))) {
    return LookupStatus::kUnhealthy;
  }
  if (!products.orbit_refused && find_any_precise(products, satellite.system, time, options, state))
    return LookupStatus::kOk;
  if (best == nullptr) {
    return !has_ephemerides && !options.use_precise ? LookupStatus::kNoEphemeris
                                                    : LookupStatus::kTooOld;
  }
  *state = broadcast_state(*best, time);
  state->issue = issue_of(*best);
  if (ephemeris != nullptr) *ephemeris = best;
  return LookupStatus::kOk;
}

bool EphemerisStore::refuse_wrong_orbit(SatelliteId satellite, GpsTime time) {
  if (!is_valid(satellite) || time.nanoseconds() <= 0) return false;
  if (satellite.system == System::kLeo) return false;
  const EphemerisConfig& options = storage_->options;
  SatelliteProducts& products = storage_->products_of[table_index_of(satellite)];
  const Ephemeris* best = best_ephemeris(storage_->ephemerides, satellite, time, options);
  if (best == nullptr) {  // nothing that could serve in its place
    products.orbit_refused = false;
    return false;
  }
  const bool is_due = !products.compared_at.is_set() ||
                      std::abs(seconds_between(time, products.compared_at)) >= kCompareInterval_s;
  if (!is_due) return false;
  if (std::abs(seconds_between(time, best->toe)) > kMaxComparedAge_s) return false;
  SatelliteState precise;
  if (!find_any_precise(products, satellite.system, time, options, &precise)) return false;
  products.compared_at = time;
  const bool was_refused = products.orbit_refused;
  const double limit_m = (was_refused ? 0.5 : 1.0) * max_difference_m(satellite.system);
  products.orbit_refused = (precise.p_e - broadcast_state(*best, time).p_e).norm() > limit_m;
  return products.orbit_refused && !was_refused;
}

bool EphemerisStore::is_orbit_refused(SatelliteId satellite, GpsTime time) const {
  if (!is_valid(satellite) || time.nanoseconds() <= 0) return false;
  const SatelliteProducts& products = storage_->products_of[table_index_of(satellite)];
  SatelliteState precise;
  return products.orbit_refused &&
         find_any_precise(products, satellite.system, time, storage_->options, &precise);
}

const Ephemeris* EphemerisStore::ephemeris_at(SatelliteId satellite, GpsTime time) const {
  if (!is_valid(satellite) || time.nanoseconds() <= 0) return nullptr;
  return best_ephemeris(storage_->ephemerides, satellite, time, storage_->options);
}

const Ephemeris* EphemerisStore::ephemeris_of_issue(SatelliteId satellite,
                                                    std::uint32_t issue) const {
  if (!is_valid(satellite)) return nullptr;
  for (const StoredEphemeris& stored : storage_->ephemerides[table_index_of(satellite)])
    if (issue_of(stored.ephemeris) == issue) return &stored.ephemeris;
  return nullptr;
}

}  // namespace leonav
