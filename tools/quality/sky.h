// What a log's own satellites, orbits and codes say of one epoch: where the antenna is, where each
// satellite stands, which are usable, and how good their geometry is.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>

#include "core/gnss/band_bias.h"
#include "core/gnss/dop.h"
#include "core/gnss/gnss_config.h"
#include "core/gnss/measurement.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"

namespace leonav {

class Sky {
 public:
  explicit Sky(const GnssConfig& config);

  SatelliteCatalog* catalog() { return &catalog_; }

  // Point solution of the epoch. Where there is none, directions are those from the last place
  // known: they change by a degree in 100 km.
  void look(const RawEpoch& raw);

  bool is_solved() const { return solved_; }
  bool has_place() const { return !place_e_.isZero(); }
  const Eigen::Vector3d& place_e() const { return place_e_; }  // m, ECEF; zero: never known
  // 1 sigma of the place, every direction; m.
  double place_sigma_m() const { return place_sigma_m_; }
  // Of the usable satellites; all NaN where they determine no position.
  const Dop& dop() const { return dop_; }
  // Every satellite of the epoch, in its order, with its reason.
  const MeasurementEpoch& epoch() const { return *epoch_; }
  const SatelliteInView* find(SatelliteId satellite) const;

 private:
  GnssConfig config_;
  SatelliteCatalog catalog_;
  BandBiases biases_;
  std::unique_ptr<MeasurementEpoch> epoch_ = std::make_unique<MeasurementEpoch>();
  bool solved_ = false;
  Eigen::Vector3d place_e_ = Eigen::Vector3d::Zero();
  double place_sigma_m_ = 0.0;
  Dop dop_;
};

// Above the mask, with orbit, healthy, and with a code that a position can be computed from,
// whatever the position then makes of it.
bool is_usable(Reason reason);

// Direction known: there is an orbit for it, and a place to look from.
bool has_direction(const SatelliteInView& satellite, bool has_place);

}  // namespace leonav
