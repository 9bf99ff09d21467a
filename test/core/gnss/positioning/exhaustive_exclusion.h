// What the codes of one epoch can tell at all about which of them are wrong: every set of
// satellites is left out in turn, and the rest fitted.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/gnss/measurement/measurement.h"
#include "core/gnss/measurement/range_model.h"
#include "support/dense/dense_algebra.h"

namespace leonav::test {

// The codes of an epoch, one per satellite, linearized at the true position.
class CodeProblem {
 public:
  using Set = unsigned;  // a bit per satellite

  struct Fit {
    double sum = 0.0;  // of squared standardized residuals
    int redundancy = 0;
    Eigen::Vector3d error = Eigen::Vector3d::Zero();  // of the position, m
  };

  CodeProblem(const MeasurementEpoch& epoch, const Eigen::Vector3d& true_p_e) {
    for (const Measurement& code : epoch.measurements) {
      if (code.observable != Observable::kCode) continue;
      const SatelliteInView& satellite = epoch.satellites[code.satellite_index];
      const RangePrediction range = predict_range(satellite, true_p_e);
      Row row = Row::Zero();
      row.head<3>() = range.d_range_d_p;
      row(3 + static_cast<Eigen::Index>(index_of(satellite.satellite.system))) = 1.0;
      rows_.push_back(row / code.sigma);
      values_.push_back((code.value - range.range_m) / code.sigma);
      satellites_.push_back(satellite.satellite);
    }
  }

  Set set_of(const std::vector<SatelliteId>& ids) const {
    Set set = 0;
    for (std::size_t i = 0; i < satellites_.size(); ++i) {
      if (std::find(ids.begin(), ids.end(), satellites_[i]) != ids.end()) set |= 1U << i;
    }
    return set;
  }

  // Weighted least squares without `left_out`. nullopt: nothing checks the rest.
  std::optional<Fit> fit(Set left_out) const {
    const auto count = static_cast<Eigen::Index>(rows_.size()) - __builtin_popcount(left_out);
    Eigen::MatrixXd design(count, Row::SizeAtCompileTime);
    Eigen::VectorXd values(count);
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if ((left_out >> i & 1U) != 0) continue;
      design.row(next) = rows_[i];
      values(next++) = values_[i];
    }
    // A system that nothing observes gives a column of zeros, which does not count in the rank.
    const dense::ShortestFit fit = dense::shortest_fit(design, values);
    if (fit.rank >= count) return std::nullopt;
    return Fit{(values - design * fit.solution).squaredNorm(), static_cast<int>(count - fit.rank),
               fit.solution.head<3>()};
  }

  // Whether no method can tell that `wrong` (three satellites) are: fewer errors explain the data
  // within their noise, or three others explain them better (for errors of any size and normal
  // noise the most likely set is the one without which the sum is least).
  bool is_ambiguous(Set wrong) const {
    constexpr std::array<double, 10> kChiSquare95 = {3.84,  5.99,  7.81,  9.49,  11.07,
                                                     12.59, 14.07, 15.51, 16.92, 18.31};
    const auto truth = fit(wrong);
    const int most = __builtin_popcount(wrong);
    for (Set set = 0; set < 1U << rows_.size(); ++set) {
      const int size = __builtin_popcount(set);
      if (size > most || set == wrong) continue;
      const auto other = fit(set);
      if (!other || !truth) return true;
      if (size == most && other->sum < truth->sum) return true;
      const auto degrees = static_cast<std::size_t>(other->redundancy);
      if (size < most && degrees <= kChiSquare95.size() && other->sum < kChiSquare95[degrees - 1])
        return true;
    }
    return false;
  }

 private:
  using Row = Eigen::Matrix<double, 1, 3 + static_cast<int>(kSystemCount)>;
  std::vector<Row> rows_;
  std::vector<double> values_;
  std::vector<SatelliteId> satellites_;
};

}  // namespace leonav::test
