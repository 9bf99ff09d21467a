// Keeps the ephemerides and precise states received so far and answers "where was satellite s at
// time t". Fixed capacity, no allocation after construction.
#pragma once
#include <cstdint>
#include <memory>

#include "core/gnss/ephemeris.h"
#include "core/gnss/satellite_state.h"

namespace leonav {

// One precise state of one satellite: a line of an SP3 file, or of a clock file (clock only).
struct PreciseState {
  SatelliteId satellite;
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, centre of mass; all NaN: clock only
  double clock_s = 0.0;                           // NaN: no clock in this product
  bool clock_event = false;  // the clock was changed since the state before, or now
  bool maneuver = false;     // the orbit was changed since the state before, or now
  bool clock_predicted = false, orbit_predicted = false;  // not from observations

  bool is_clock_only() const { return p_e.array().isNaN().all(); }
};

enum class LookupStatus : std::uint8_t {
  kOk = 0,
  kNoEphemeris,  // nothing stored for this satellite
  kTooOld,       // nothing stored that is valid at this time
  kUnhealthy,
};

struct CatalogOptions {
  bool use_precise = true;        // precise states before broadcast ones where both exist
  double max_age_gps_s = 7200.0;  // |t - toe|
  double max_age_galileo_s = 14400.0;
  double max_age_beidou_s = 21600.0;
  double max_age_leo_s = 7200.0;
  double max_orbit_gap_s = 1000.0;  // precise nodes farther apart than this are not bridged
  double max_clock_gap_s = 45.0;    // likewise those of clock files; else the orbits' clocks serve
  // F/NAV (E1,E5a clock) instead of I/NAV (E1,E5b) where both are there for one toe.
  bool galileo_prefers_fnav = false;
};

class SatelliteCatalog {
 public:
  explicit SatelliteCatalog(const CatalogOptions& options);
  ~SatelliteCatalog();
  SatelliteCatalog(SatelliteCatalog&&) noexcept;
  SatelliteCatalog& operator=(SatelliteCatalog&&) noexcept;

  // False if the ephemeris is not sane (nothing changes). A repeated issue replaces its
  // predecessor; when full, what arrived first of that satellite goes, so that wrong times in the
  // input cannot block a place for good.
  bool add(const Ephemeris& ephemeris);
  bool add(const PreciseState& state);
  void set_klobuchar(const KlobucharModel& model);
  const KlobucharModel& klobuchar() const;

  // State at `time`; `*ephemeris` (if given) points to the elements used, or nullptr for precise.
  // Broadcast: the elements with the nearest toe. A satellite whose newest message says unhealthy
  // is unhealthy with precise states too. Precise: clocks of clock files where they enclose `time`,
  // else those that came with the orbits. Only kOk changes `*state`.
  LookupStatus state_at(SatelliteId satellite, GpsTime time, SatelliteState* state,
                        const Ephemeris** ephemeris = nullptr) const;

  // The broadcast elements for `time` whatever their health, or nullptr: they tell the group delays
  // that a precise clock needs. Valid until the next add().
  const Ephemeris* ephemeris_at(SatelliteId satellite, GpsTime time) const;

  // The broadcast elements that gave a SatelliteState of this `issue`, or nullptr. Likewise.
  const Ephemeris* elements_of(SatelliteId satellite, std::uint32_t issue) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
