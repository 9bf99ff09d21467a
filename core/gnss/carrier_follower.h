// What the carriers need from one epoch to the next: their arcs, their wind-up, and what they
// measured before.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "core/gnss/carrier_arcs.h"
#include "core/gnss/carrier_signals.h"
#include "core/gnss/measurement.h"

namespace leonav {

// Of the antenna between two epochs, as carriers alone tell it.
struct AntennaChange {
  GpsTime from, to;
  Eigen::Vector3d change_e = Eigen::Vector3d::Zero();  // m
};

// In this order, once per epoch; the observations offered must live until the end of it:
//   begin, wind_up and offer (each satellite), follow, append to the epoch;
//   check_range_changes with the predicted motion; remember with the position that came out.
class CarrierFollower {
 public:
  explicit CarrierFollower(const CycleSlipConfig& config);

  void begin(GpsTime time);
  // The pair of signals that the satellite's arc is made of, nullptr if there is none or it has
  // been missing for too long to go on.
  const CarrierPairCodes* followed_pair(SatelliteId satellite) const;
  void offer(const CarrierChoice& choice, double elevation);
  // Statuses in the order of the offers; stays until the next epoch.
  const ArcEpoch& follow();

  // Of the orbit that the satellite's carrier was last remembered with; 0: none.
  std::uint32_t last_issue(SatelliteId satellite) const;
  // The satellite's wind-up at the last epoch, cycles; 0 for a new one.
  double last_wind_up(SatelliteId satellite) const;
  void set_wind_up(SatelliteId satellite, double cycles);

  // Tests the carriers of `epoch` (appended in the order of the offers; those left out there have
  // no measurement) against each other and the predicted motion, and gives each its arc.
  // `predicted_p_e`: the antenna as predicted. Also says which carriers are disturbed by another
  // orbit or antenna pattern, and by how much the position.
  void check_range_changes(const Eigen::Vector3d& predicted_p_e, const RangeChangePrior& prior,
                           MeasurementEpoch* epoch);
  // Between the last call and remember(): since the last epoch with carriers, whatever the filter
  // has predicted. `prior`: as there. nullopt: no satellite more than it takes.
  std::optional<AntennaChange> antenna_change(RangeChangePrior prior) const;
  // `antenna_p_e`: as estimated with this epoch.
  void remember(const MeasurementEpoch& epoch, const Eigen::Vector3d& antenna_p_e);
  // The estimator has found that the arc of one of the epoch's satellites slipped: another begins
  // here. After remember(): the next epoch must not be compared with the old arc.
  void end_arc(SatelliteId satellite, MeasurementEpoch* epoch);
  // What the position was is not known any more: the next epoch's range changes are not tested.
  void forget_position() { last_time_ = GpsTime(); }
  void reset();

  GpsTime last_time() const { return last_time_; }

 private:
  struct Memory {
    SatelliteId satellite;
    GpsTime seen;
    GpsTime time;  // of the last carrier remembered
    std::uint32_t arc = 0;
    double residual_m = 0.0;  // measured minus geometric range
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double variance_m2 = 0.0;
    std::uint32_t issue = 0;
    double orbit_sigma_m = 0.0;
    OrbitSource source = OrbitSource::kNone;
    std::uint32_t antenna_issue = 0;
    double antenna_m = 0.0;
    double wind_up_cycles = 0.0;
    GpsTime offered;  // when `pair` was last measured
    CarrierPairCodes pair;
  };
  Memory* memory_of(SatelliteId satellite);
  const Memory* memory_of(SatelliteId satellite) const;
  RangeChangeRow row_of(const SatelliteInView& satellite, const Measurement& carrier,
                        const Memory& before, const Eigen::Vector3d& predicted_p_e) const;
  bool is_comparable(const SatelliteInView& satellite, const Measurement& carrier,
                     const Memory* before) const;
  double antenna_step_m(const SatelliteInView& satellite, const Memory& before) const;
  void disturb(MeasurementEpoch* epoch) const;

  CycleSlipConfig config_;
  CarrierArcs arcs_;
  ArcEpoch arc_epoch_;
  boost::container::static_vector<CarrierInput, kMaxSatellites> inputs_;
  boost::container::static_vector<Memory, kMaxSatellites> memory_;
  // Of the last check: its rows, and where the antenna was predicted; where it was estimated
  // before.
  boost::container::static_vector<RangeChangeRow, kMaxSatellites> change_rows_;
  Eigen::Vector3d predicted_p_e_ = Eigen::Vector3d::Zero(), last_p_e_ = Eigen::Vector3d::Zero();
  GpsTime time_, last_time_;
};

}  // namespace leonav
