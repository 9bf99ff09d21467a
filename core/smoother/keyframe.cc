#include "core/smoother/keyframe.h"

namespace leonav {

using Eigen::Index;

EkfCorrection active_part(const ActiveStates& active, const EkfCorrection& error) {
  EkfCorrection part(active.size());
  for (Index i = 0; i < active.core_size(); ++i)
    part(i) = error(active.core[static_cast<std::size_t>(i)]);
  part.tail(active.ambiguities) = error.tail(active.ambiguities);
  return part;
}

EkfCorrection full_error(const ActiveStates& active, const EkfCorrection& part) {
  EkfCorrection error = EkfCorrection::Zero(active.before_ambiguities + active.ambiguities);
  for (Index i = 0; i < active.core_size(); ++i)
    error(active.core[static_cast<std::size_t>(i)]) = part(i);
  error.tail(active.ambiguities) = part.tail(active.ambiguities);
  return error;
}

}  // namespace leonav
