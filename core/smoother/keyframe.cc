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

ArcJoins joins_of(const KeyframeInput& input) {
  ArcJoins joins;
  const Index first = input.from.first_ambiguity();
  const auto value_m = [&](int i) {
    return input.from.ambiguities[static_cast<std::size_t>(i)].value_m;
  };
  for (const ProcessJoin& given : input.process.joins) {
    ArcJoin join;
    join.from = static_cast<int>(given.from - first);
    join.to = static_cast<int>(given.to - first);
    join.difference_m = value_m(join.to) - value_m(join.from) + given.innovation_m;
    join.variance = given.variance;
    joins.push_back(join);
  }
  return joins;
}

}  // namespace leonav
