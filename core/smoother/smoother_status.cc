#include "core/smoother/smoother_status.h"

namespace leonav {

std::string_view to_string(SmootherStatus status) {
  switch (status) {
    case SmootherStatus::kOk:
      return "ok";
    case SmootherStatus::kNoFilter:
      return "no_filter";
    case SmootherStatus::kStarted:
      return "started";
    case SmootherStatus::kSingular:
      return "singular";
    case SmootherStatus::kDiverged:
      return "diverged";
    case SmootherStatus::kFewSatellites:
      return "few_satellites";
  }
  return "unknown";
}

}  // namespace leonav
