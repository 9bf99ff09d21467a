// This unit keeps what carriers need from one epoch to the next: their arcs, their wind-up, and
// their previous values.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "core/gnss/cycle_slips/carrier_arcs.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/preprocessing/internal/carrier_selection.h"

namespace leonav {

// Change of the antenna position between two epochs, from carriers alone.
struct AntennaChange {
  GpsTime from, to;
  Eigen::Vector3d change_e = Eigen::Vector3d::Zero();  // m
};

// The calls have this order, once per epoch; the observations given to add_carrier must live until
// its end:
//   begin, wind_up and add_carrier (each satellite), update_arcs, append to the epoch;
//   check_range_changes with the predicted motion; store_epoch with the estimated position.
class CarrierPreprocessor {
 public:
  // `bands`: the carriers of the LEO satellites.
  explicit CarrierPreprocessor(const CycleSlipConfig& config, const BandPlan& bands = {});

  void begin(GpsTime time);
  // Returns the pair of signals of the satellite's arc, or nullptr if there is none or it has been
  // missing for too long to continue.
  const CarrierPairCodes* tracked_pair(SatelliteId satellite) const;
  void add_carrier(const CarrierChoice& choice, double elevation);
  // Returns the statuses in the order of add_carrier(); they are valid until the next epoch.
  const ArcEpoch& update_arcs();

  // Returns the issue of the orbit with which the satellite's carrier was last stored; 0: none.
  std::uint32_t last_issue(SatelliteId satellite) const;
  // Returns the satellite's wind-up at the last epoch, in cycles; 0 for a new satellite.
  double last_wind_up(SatelliteId satellite) const;
  void set_wind_up(SatelliteId satellite, double cycles);

  // Tests the carriers of `epoch` against each other and the predicted motion, and gives each its
  // arc. The carriers are appended in the order of add_carrier(); excluded ones have no measurement
  // there. `predicted_p_e` is the predicted antenna position (ECEF, m). It also sets by how much
  // another orbit, antenna pattern or model of the ionosphere disturbs each carrier, and an antenna
  // pattern the position.
  void check_range_changes(const Eigen::Vector3d& predicted_p_e, const RangeChangePrior& prior,
                           MeasurementEpoch* epoch);
  // Returns the change since the last epoch with carriers, whatever the filter has predicted. It
  // must be called after check_range_changes() and before store_epoch(). `prior` is that of
  // check_range_changes(). Returns nullopt without a redundant satellite.
  std::optional<AntennaChange> antenna_change(RangeChangePrior prior) const;
  // Stores the carriers for the next epoch; `antenna_p_e` (ECEF, m) is estimated with this epoch.
  void store_epoch(const MeasurementEpoch& epoch, const Eigen::Vector3d& antenna_p_e);
  // Begins another arc here, because the estimator found that the arc of one of the epoch's
  // satellites slipped. It must be called after store_epoch(): the next epoch must not be compared
  // with the old arc.
  void end_arc(SatelliteId satellite, MeasurementEpoch* epoch);
  // Discards the stored position: the range changes of the next epoch are not tested.
  void reset_position() { last_time_ = GpsTime(); }
  void reset();

  GpsTime last_time() const { return last_time_; }

 private:
  struct CarrierHistory {
    SatelliteId satellite;
    GpsTime seen;
    GpsTime time;  // time of the last carrier stored
    std::uint32_t arc = 0;
    double residual_m = 0.0;  // measured minus geometric range
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double variance_m2 = 0.0;
    std::uint32_t issue = 0;
    double orbit_sigma_m = 0.0;
    OrbitSource source = OrbitSource::kNone;
    std::uint32_t antenna_issue = 0;
    double antenna_m = 0.0;
    std::uint32_t ionosphere_issue = 0;
    double ionosphere_m = 0.0;
    double wind_up_cycles = 0.0;
    GpsTime offered;  // time at which `pair` was last measured
    CarrierPairCodes pair;
  };
  CarrierHistory* history_of(SatelliteId satellite);
  const CarrierHistory* history_of(SatelliteId satellite) const;
  RangeChangeRow row_of(const SatelliteInView& satellite, const Measurement& carrier,
                        const CarrierHistory& before, const Eigen::Vector3d& predicted_p_e) const;
  bool is_comparable(const SatelliteInView& satellite, const Measurement& carrier,
                     const CarrierHistory* before) const;
  double antenna_step_m(const SatelliteInView& satellite, const CarrierHistory& before) const;
  double ionosphere_step_m(const SatelliteInView& satellite, const CarrierHistory& before) const;
  void set_disturbances(MeasurementEpoch* epoch) const;

  CycleSlipConfig config_;
  BandPlan bands_;
  CarrierArcs arcs_;
  ArcEpoch arc_epoch_;
  boost::container::static_vector<CarrierInput, kMaxSatellites> inputs_;
  boost::container::static_vector<CarrierHistory, kMaxSatellites> histories_;
  // The rows of the last check, the predicted antenna position of that check, and the position
  // estimated before it.
  boost::container::static_vector<RangeChangeRow, kMaxSatellites> change_rows_;
  Eigen::Vector3d predicted_p_e_ = Eigen::Vector3d::Zero(), last_p_e_ = Eigen::Vector3d::Zero();
  GpsTime time_, last_time_;
};

}  // namespace leonav
