#include "core/smoother/keyframe.h"

namespace leonav {

using Eigen::Index;

EkfCorrection active_part(const ActiveStates& active, const EkfCorrection& error) {
  EkfCorrection part(active.size());
  for (Index i = 0; i < active.core_size(); ++i)
    part(i) = error(active.core[static_cast<std::size_t>(i)]);
  part.tail(active.signal_states) = error.tail(active.signal_states);
  return part;
}

EkfCorrection full_error(const ActiveStates& active, const EkfCorrection& part) {
  EkfCorrection error = EkfCorrection::Zero(active.before_signal_states + active.signal_states);
  for (Index i = 0; i < active.core_size(); ++i)
    error(active.core[static_cast<std::size_t>(i)]) = part(i);
  error.tail(active.signal_states) = part.tail(active.signal_states);
  return error;
}

}  // namespace leonav
