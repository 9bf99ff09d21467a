#include "core/gnss/propagation/antenna_pattern_store.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/base/pooled_lists.h"

namespace leonav {
namespace {

// The pattern of one band of one satellite's antenna over one interval of validity.
struct SatelliteBand {
  char band = 0;
  GpsTime valid_from, valid_until;
  std::uint64_t arrival = 0;   // the last one, also of an identical pattern
  std::uint64_t revision = 0;  // the arrival of the first that was identical
  mutable GpsTime used;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  double first_angle = 0.0, angle_step = 0.0;
  int angles = 0;
  std::array<float, kMaxNadirValues> values{};

  AntennaGridView grid() const {
    return {first_angle, angle_step, angles, angles > 0 ? 1 : 0, values.data()};
  }
  bool holds_at(GpsTime time) const {
    return (!valid_from.is_set() || valid_from <= time) &&
           (!valid_until.is_set() || time <= valid_until);
  }
};

struct ReceiverBand {
  AntennaPattern pattern;
  std::uint64_t arrival = 0;
};

constexpr std::size_t kMaxEntries = kMaxSatelliteAntennaBands * kMaxAntennaIntervals;
using SatelliteBands =
    PooledLists<SatelliteBand, kMaxEphemerisSatellites, kMaxEntries, kMaxSatelliteAntennas>;

bool is_same(const SatelliteBand& a, const SatelliteBand& b) {
  return a.band == b.band && a.valid_from == b.valid_from && a.valid_until == b.valid_until &&
         a.offset_m == b.offset_m && a.first_angle == b.first_angle &&
         a.angle_step == b.angle_step && a.angles == b.angles && a.values == b.values;
}

bool is_same(const AntennaPattern& a, const AntennaPattern& b) {
  return a.satellite == b.satellite && a.band == b.band && a.offset_m == b.offset_m &&
         a.variation.first_angle == b.variation.first_angle &&
         a.variation.angle_step == b.variation.angle_step &&
         a.variation.angles == b.variation.angles && a.variation.azimuths == b.variation.azimuths &&
         a.variation.values == b.variation.values;
}

SatelliteBand compact(const AntennaPattern& pattern, std::uint64_t arrival) {
  SatelliteBand entry;
  entry.band = pattern.band;
  entry.valid_from = pattern.valid_from;
  entry.valid_until = pattern.valid_until;
  entry.arrival = entry.revision = arrival;
  entry.offset_m = pattern.offset_m;
  entry.first_angle = pattern.variation.first_angle;
  entry.angle_step = pattern.variation.angle_step;
  entry.angles = pattern.variation.angles;
  std::copy(pattern.variation.values.begin(), pattern.variation.values.end(), entry.values.begin());
  return entry;
}

// Returns the slot for a pattern of this band and start of validity: the same pattern's, a free
// one, or that of the oldest of its band. Returns nullptr where there are too many bands.
SatelliteBand* slot_for(const AntennaPattern& pattern, SatelliteBands* bands) {
  const std::size_t satellite = table_index_of(pattern.satellite);
  SatelliteBand* oldest = nullptr;
  std::size_t of_band = 0;
  for (SatelliteBand& entry : (*bands)[satellite]) {
    if (entry.band != pattern.band) continue;
    if (entry.valid_from == pattern.valid_from) return &entry;
    ++of_band;
    if (oldest == nullptr || entry.arrival < oldest->arrival) oldest = &entry;
  }
  if (of_band >= kMaxAntennaIntervals) return oldest;
  return bands->is_full(satellite) ? nullptr : &bands->append(satellite);
}

}  // namespace

struct AntennaPatternStore::Storage {
  BandPlan bands;
  SatelliteBands satellites;
  boost::container::static_vector<ReceiverBand, kMaxReceiverAntennaBands> receiver;
  std::uint64_t arrivals = 0;
  Counters counters;

  double distance_hz(System a, char band_a, System b, char band_b) const {
    return std::abs(bands.frequency_hz(a, band_a) - bands.frequency_hz(b, band_b));
  }

  bool add_satellite(const AntennaPattern& pattern) {
    SatelliteBand* slot = slot_for(pattern, &satellites);
    if (slot == nullptr) return false;
    const SatelliteBand entry = compact(pattern, ++arrivals);
    if (is_same(*slot, entry))
      slot->arrival = arrivals;
    else
      *slot = entry;
    return true;
  }

  bool add_receiver(const AntennaPattern& pattern) {
    for (ReceiverBand& known : receiver) {
      if (known.pattern.satellite != pattern.satellite || known.pattern.band != pattern.band)
        continue;
      if (!is_same(known.pattern, pattern)) known = {pattern, ++arrivals};
      return true;
    }
    if (receiver.size() == receiver.capacity()) return false;
    receiver.push_back({pattern, ++arrivals});
    return true;
  }

  // Returns the entry that is valid at `time` and nearest in frequency; of several of one band, the
  // one whose validity began last.
  const SatelliteBand* find(SatelliteId satellite, char band, GpsTime time) const {
    const SatelliteBand* best = nullptr;
    double best_hz = satellite.system == System::kLeo ? 1.0 : kMaxNeighbour_hz;
    for (const SatelliteBand& entry : satellites[table_index_of(satellite)]) {
      if (!entry.holds_at(time)) continue;
      const double hz = distance_hz(satellite.system, band, satellite.system, entry.band);
      const bool later =
          best != nullptr && entry.band == best->band && entry.valid_from > best->valid_from;
      if (best != nullptr ? hz < best_hz || later : hz <= best_hz) {
        best = &entry;
        best_hz = hz;
      }
    }
    if (best != nullptr) satellites.mark_used(*best, time);
    return best;
  }
};

AntennaPatternStore::AntennaPatternStore(const BandPlan& bands)
    : storage_(std::make_unique<Storage>()) {
  storage_->bands = bands;
}
AntennaPatternStore::~AntennaPatternStore() = default;
AntennaPatternStore::AntennaPatternStore(AntennaPatternStore&&) noexcept = default;
AntennaPatternStore& AntennaPatternStore::operator=(AntennaPatternStore&&) noexcept = default;

bool AntennaPatternStore::add(const AntennaPattern& pattern) {
  const bool added =
      is_storable(pattern) &&
      (pattern.is_receiver ? storage_->add_receiver(pattern) : storage_->add_satellite(pattern));
  ++(added ? storage_->counters.added : storage_->counters.refused);
  return added;
}

AntennaRange AntennaPatternStore::satellite_range(SatelliteId satellite, char band, GpsTime time,
                                                  const Eigen::Vector3d& p_sat_e,
                                                  const Eigen::Matrix3d& C_es,
                                                  const Eigen::Vector3d& p_a_e) const {
  if (!is_valid(satellite) || !(storage_->bands.frequency_hz(satellite.system, band) > 0.0))
    return {};
  const SatelliteBand* entry = storage_->find(satellite, band, time);
  if (entry == nullptr) return {};
  return {satellite_antenna_range_m(entry->offset_m, entry->grid(), p_sat_e, C_es, p_a_e),
          entry->band == band ? AntennaStatus::kOk : AntennaStatus::kNeighbourBand,
          entry->revision};
}

AntennaRange AntennaPatternStore::receiver_range(System system, char band,
                                                 const Eigen::Vector3d& u_r) const {
  if (!(storage_->bands.frequency_hz(system, band) > 0.0)) return {};
  const ReceiverBand* best = nullptr;
  double best_hz = kMaxNeighbour_hz;
  for (const ReceiverBand& entry : storage_->receiver) {
    const AntennaPattern& pattern = entry.pattern;
    const double hz = storage_->distance_hz(system, band, pattern.satellite.system, pattern.band);
    const bool own = hz == best_hz && pattern.satellite.system == system;
    if (hz < best_hz || own || (best == nullptr && hz <= best_hz)) {
      best = &entry;
      best_hz = hz;
    }
  }
  if (best == nullptr) return {};
  const AntennaPattern& pattern = best->pattern;
  return {receiver_antenna_range_m(pattern.offset_m, view(pattern.variation), u_r),
          best_hz < 1.0 ? AntennaStatus::kOk : AntennaStatus::kNeighbourBand, best->arrival};
}

const AntennaPatternStore::Counters& AntennaPatternStore::counters() const {
  return storage_->counters;
}

}  // namespace leonav
