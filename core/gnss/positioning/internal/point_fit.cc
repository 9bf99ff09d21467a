#include "core/gnss/positioning/internal/point_fit.h"

#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/range_model.h"

namespace leonav {
namespace {

class PositionModel : public FitModel {
 public:
  explicit PositionModel(const MeasurementEpoch& epoch) : epoch_(epoch) {}
  void linearize(const FitState& state, FitRows* rows) const override {
    for (FitRow& row : *rows) {
      const Measurement& code = epoch_.measurements[row.source];
      const RangePrediction range =
          predict_range(epoch_.satellites[code.satellite_index], state.head<3>());
      row.direction = range.d_range_d_p.transpose();
      row.residual = code.value - range.range_m - state(3 + row.group);
    }
  }

 private:
  const MeasurementEpoch& epoch_;
};

class VelocityModel : public FitModel {
 public:
  VelocityModel(const MeasurementEpoch& epoch, const Eigen::Vector3d& p_a_e)
      : epoch_(epoch), p_a_e_(p_a_e) {}
  void linearize(const FitState& state, FitRows* rows) const override {
    for (FitRow& row : *rows) {
      const Measurement& doppler = epoch_.measurements[row.source];
      const RangeRatePrediction rate =
          predict_range_rate(epoch_.satellites[doppler.satellite_index], p_a_e_, state.head<3>());
      row.direction = rate.d_rate_d_v.transpose();
      row.residual = doppler.value - rate.range_rate_m_s - state(3);
    }
  }

 private:
  const MeasurementEpoch& epoch_;
  const Eigen::Vector3d p_a_e_;
};

FitRow row_of(const MeasurementEpoch& epoch, std::size_t index) {
  FitRow row;
  row.source = index;
  row.satellite = epoch.measurements[index].satellite_index;
  row.sigma = epoch.measurements[index].sigma;
  return row;
}

}  // namespace

void fit_position(const MeasurementEpoch& epoch, const RobustConfig& robust,
                  const Eigen::Vector3d& start_e, PositionFit* result) {
  result->state.setZero();
  result->state.head<3>() = start_e;
  result->rows.clear();
  for (std::size_t i = 0; i < epoch.measurements.size(); ++i) {
    if (epoch.measurements[i].observable != Observable::kCode) continue;
    FitRow row = row_of(epoch, i);
    const SatelliteInView& satellite = epoch.satellites[epoch.measurements[i].satellite_index];
    row.group = static_cast<int>(index_of(satellite.satellite.system));
    result->rows.push_back(row);
  }
  result->fit = robust_fit(PositionModel(epoch), robust, &result->state, &result->rows);
}

void fit_velocity(const MeasurementEpoch& epoch, const RobustConfig& robust,
                  const Eigen::Vector3d& p_a_e, VelocityFit* result) {
  result->state.setZero();
  result->rows.clear();
  for (std::size_t i = 0; i < epoch.measurements.size(); ++i) {
    if (epoch.measurements[i].observable != Observable::kDoppler) continue;
    result->rows.push_back(row_of(epoch, i));
  }
  result->fit = robust_fit(VelocityModel(epoch, p_a_e), robust, &result->state, &result->rows);
}

Eigen::Vector3d surface_below(const MeasurementEpoch& epoch) {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode) continue;
    direction += epoch.satellites[measurement.satellite_index].p_e.normalized();
  }
  if (direction.norm() < 1.0e-3) return Eigen::Vector3d(kEarthSemiMajorAxis, 0.0, 0.0);
  return kEarthSemiMajorAxis * direction.normalized();
}

}  // namespace leonav
