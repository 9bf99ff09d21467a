// This unit keeps the antenna patterns received so far and computes range corrections from them.
// Its capacity is fixed and it allocates only at construction.
#pragma once
#include <cstdint>
#include <memory>

#include "core/gnss/propagation/antenna_model.h"
#include "core/gnss/signals/band_plan.h"

namespace leonav {

// Origin of a correction.
enum class AntennaStatus : std::uint8_t {
  kOk = 0,
  kNeighbourBand,  // from a neighbouring band: good to a centimetre or so
  kNone,           // no pattern known: no correction
};

// A range correction with its origin.
struct AntennaRange {
  double range_m = 0.0;  // to ADD to the geometric range; zero with kNone
  AntennaStatus status = AntennaStatus::kNone;
  std::uint64_t revision = 0;  // a new value means another pattern; 0 with kNone
};

// Where the pattern of a band is missing, the band of the same antenna nearest in frequency serves,
// if it is at most kMaxNeighbour_hz away: GPS L5 takes that of L2, Galileo E6 that of E5b. The
// bands of a receiver antenna serve all systems, since only the frequency counts: a band of exactly
// the same frequency is kOk (Galileo E1 for GPS L1). A LEO satellite's antenna has no neighbouring
// bands.
class AntennaPatternStore {
 public:
  static constexpr double kMaxNeighbour_hz = 120e6;  // within upper, within lower L band

  // `bands`: the carriers of the LEO satellites.
  explicit AntennaPatternStore(const BandPlan& bands = {});
  ~AntennaPatternStore();
  AntennaPatternStore(AntennaPatternStore&&) noexcept;
  AntennaPatternStore& operator=(AntennaPatternStore&&) noexcept;

  // Returns false (and changes nothing) if the pattern is not sane, if a satellite's depends on
  // azimuth or has more than kMaxNadirValues values, or if no slot for another band is free. A
  // pattern replaces the one of the same antenna, band and start of validity; an identical one
  // counts as arrived again, and leaves the revision. Where kMaxAntennaIntervals other intervals
  // are stored, it replaces the one that arrived first. There is one receiver antenna; its validity
  // is ignored. Beyond kMaxSatelliteAntennas patterns, a satellite with most loses the one that
  // arrived first and has not served within the last minute.
  bool add(const AntennaPattern& pattern);

  // Compute satellite_antenna_range_m and receiver_antenna_range_m with the pattern for the
  // signal's `system` and `band` (and the time). Positions are ECEF, m.
  AntennaRange satellite_range(SatelliteId satellite, char band, GpsTime time,
                               const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                               const Eigen::Vector3d& p_a_e) const;
  AntennaRange receiver_range(System system, char band, const Eigen::Vector3d& u_r) const;

  // Numbers of patterns kept and refused since construction.
  struct Counters {
    std::uint64_t added = 0, refused = 0;
  };
  const Counters& counters() const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
