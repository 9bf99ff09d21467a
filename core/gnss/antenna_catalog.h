// Keeps the antenna patterns received so far. Fixed capacity, no allocation after construction.
#pragma once
#include <cstdint>
#include <memory>

#include "core/gnss/antenna_model.h"

namespace leonav {

enum class AntennaStatus : std::uint8_t {
  kOk = 0,
  kNeighbourBand,  // of a neighbouring band: good to a centimetre or so
  kNone,           // nothing known: no correction
};

struct AntennaRange {
  double range_m = 0.0;  // to ADD to the geometric range; zero with kNone
  AntennaStatus status = AntennaStatus::kNone;
  std::uint64_t revision = 0;  // another one, another pattern; 0 with kNone
};

// Where a band is missing the nearest one in frequency of the same antenna serves, if it is at most
// kMaxNeighbour_hz away: GPS L5 takes L2's, Galileo E6 takes E5b's. Of a receiver antenna the bands
// of all systems serve each other, since only the frequency counts: one of exactly the same
// frequency is kOk (Galileo E1 for GPS L1). Of a LEO satellite's antenna a missing band has no
// neighbour.
class AntennaCatalog {
 public:
  static constexpr double kMaxNeighbour_hz = 120e6;  // within upper, within lower L band

  AntennaCatalog();
  ~AntennaCatalog();
  AntennaCatalog(AntennaCatalog&&) noexcept;
  AntennaCatalog& operator=(AntennaCatalog&&) noexcept;

  // False if the pattern is not sane, or a satellite's depends on azimuth or has more than
  // kMaxNadirValues values, or no band's place is left (nothing changes). A pattern replaces that
  // of the same antenna, band and start of validity (one and the same once more changes
  // nothing, its revision neither); when kMaxAntennaIntervals others are there,
  // the one that arrived first. There is one receiver antenna; its validity is not looked at.
  bool add(const AntennaPattern& pattern);

  // As satellite_antenna_range_m and receiver_antenna_range_m, with the pattern for the band (and
  // the time). `system` and `band` of the signal.
  AntennaRange satellite_range(SatelliteId satellite, char band, GpsTime time,
                               const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                               const Eigen::Vector3d& p_a_e) const;
  AntennaRange receiver_range(System system, char band, const Eigen::Vector3d& u_r) const;

  // How many were kept and refused since construction.
  struct Counters {
    std::uint64_t added = 0, refused = 0;
  };
  const Counters& counters() const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
