// This unit keeps the ephemerides and precise states received so far, and gives a satellite's state
// at a time. Its capacity is fixed and it allocates only at construction.
#pragma once
#include <cstdint>
#include <memory>

#include "core/gnss/orbits/corrected_state.h"
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/orbits/satellite_state.h"

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

// Outcome of a look-up.
enum class LookupStatus : std::uint8_t {
  kOk = 0,
  kNoEphemeris,  // nothing stored for this satellite
  kTooOld,       // nothing stored that is valid at this time
  kUnhealthy,
};

// Choice and limits of the products that are used at a time.
struct EphemerisConfig {
  // Corrected and precise states take precedence over broadcast ones where they exist.
  bool use_precise = true;
  // Corrected states whose clock was corrected longer ago are not used.
  double max_age_corrections_s = 60.0;
  double max_age_gps_s = 7200.0;  // |t - toe|
  double max_age_galileo_s = 14400.0;
  double max_age_beidou_s = 21600.0;
  double max_age_leo_s = 900.0;     // elements of a low orbit are fitted to minutes of it
  double max_orbit_gap_s = 1000.0;  // precise nodes farther apart than this are not interpolated
  // This is the same limit for nodes of clock files; beyond it the orbits' clocks are used.
  double max_clock_gap_s = 45.0;
  // Prefers F/NAV (E1,E5a clock) to I/NAV (E1,E5b) where both exist for one toe.
  bool galileo_prefers_fnav = false;

  // Returns how long before and after its toe a broadcast ephemeris of the system is used, s.
  double max_age_s(System system) const;
  bool operator==(const EphemerisConfig&) const = default;
};

// EphemerisStore holds the products of all satellites.
class EphemerisStore {
 public:
  explicit EphemerisStore(const EphemerisConfig& options);
  ~EphemerisStore();
  EphemerisStore(EphemerisStore&&) noexcept;
  EphemerisStore& operator=(EphemerisStore&&) noexcept;

  // Returns false if the ephemeris is not sane, or for corrections alone (nothing changes then). A
  // repeated issue replaces its predecessor. A full table drops the entry of this satellite that
  // arrived first, so that wrong times in the input cannot block a slot permanently. Beyond
  // kMaxEphemerides of all satellites, a satellite with most loses the one that arrived first. In
  // both cases one that served a look-up within the last minute stays.
  bool add(const Ephemeris& ephemeris);
  bool add(const PreciseState& state);
  // The newest corrected state of a satellite replaces the one before, whatever its time.
  bool add(const CorrectedState& state);
  void set_klobuchar(const KlobucharModel& model);
  const KlobucharModel& klobuchar() const;
  // Returns a number that changes with the coefficients.
  std::uint32_t klobuchar_issue() const;

  // Finds the state at `time`; `*ephemeris` (if given) points to the elements used, or to nullptr
  // for others. A corrected state serves first, where it is
  // young enough, then precise ones, then broadcast elements. Broadcast: the elements with the
  // nearest toe serve. Precise: clocks of clock files serve where they enclose `time`, else those
  // that came with the orbits. A satellite whose newest message marks it unhealthy is unhealthy
  // with precise states too. `*state` changes only with kOk.
  LookupStatus state_at(SatelliteId satellite, GpsTime time, SatelliteState* state,
                        const Ephemeris** ephemeris = nullptr) const;

  // Compares the corrected or precise orbit of a satellite with its broadcast elements, where there
  // are both, once a second and where anything new has come. Where they differ by more than such
  // products do, state_at() gives the broadcast state from then on, until a comparison finds less
  // than half of that, also over a gap of the product, or until there are no broadcast elements.
  // The clocks are not compared, because each product has its own reference. LEO satellites are not
  // compared either: how good their broadcast elements are depends on the constellation. Returns
  // true where this begins.
  bool refuse_wrong_orbit(SatelliteId satellite, GpsTime time);
  // Returns whether there is a corrected or precise orbit at `time` that is not used for this.
  bool is_orbit_refused(SatelliteId satellite, GpsTime time) const;

  // Returns the broadcast elements for `time` whatever their health, or nullptr; a precise clock
  // needs their group delays. The pointer is valid until the next add().
  const Ephemeris* ephemeris_at(SatelliteId satellite, GpsTime time) const;

  // Returns the broadcast elements that gave a SatelliteState of this `issue`, or nullptr. The
  // pointer is valid until the next add().
  const Ephemeris* ephemeris_of_issue(SatelliteId satellite, std::uint32_t issue) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
