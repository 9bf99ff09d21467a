#include "core/integrity/protection_levels.h"

#include "core/integrity/level_growth.h"

namespace leonav {

ProtectionLevels protection_levels(const NominalError& nominal,
                                   std::span<const FaultHypothesis> hypotheses,
                                   const IntegrityConfig& config) {
  return LevelGrowth(nominal, hypotheses, config).at(nominal);
}

}  // namespace leonav
