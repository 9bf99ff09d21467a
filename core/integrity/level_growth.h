// LevelGrowth carries the protection levels of an epoch on while the covariance grows.
//
// At the epoch the equation of every level is solved (level_equation.h). This shares the risk among
// the hypotheses: hypothesis k has the level b_k + K_k s_k. Until the next epoch the shares stay.
// With s_k^2 = s_0^2 + (separation's variance), no s_k grows faster than the nominal s_0, so that
//   level(t) = level + K (s_0(t) - s_0),   K >= every K_k
// stays within the risk. Without fault hypotheses K is K_0, and the level is K_0 s_0(t) exactly.
// With them, a hundredth of the risk is set aside to bound every K_k (docs/models/integrity.md).
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>

#include "core/integrity/fault_hypothesis.h"
#include "core/integrity/integrity_config.h"
#include "core/integrity/protection_levels.h"

namespace leonav {

// A few numbers, whatever the number of hypotheses; cheap enough for every IMU sample.
class LevelGrowth {
 public:
  // Has no levels: at() gives NaN.
  LevelGrowth() = default;
  // Solves for the levels at an epoch.
  LevelGrowth(const NominalError& epoch, std::span<const FaultHypothesis> hypotheses,
              const IntegrityConfig& config);

  // Returns the levels while the nominal error is `now`; at the epoch's own error these are the
  // epoch's levels. Biases are those of the epoch. A sigma that has shrunk lowers no level.
  ProtectionLevels at(const NominalError& now) const;

 private:
  // The level along one direction.
  struct Component {
    double level = std::numeric_limits<double>::quiet_NaN();  // at the epoch
    double sigma = 0.0;                                       // of the nominal error, at the epoch
    double growth = 0.0;                                      // of the level with that sigma
    double at(double sigma_now) const;
  };

  std::array<Eigen::Vector3d, 3> axes_n_{};  // of the ellipse, major axis first, and down
  std::array<Component, 3> position_;        // along these axes
  Component heading_;
};

}  // namespace leonav
