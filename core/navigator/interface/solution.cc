#include "core/navigator/interface/solution.h"

namespace leonav {

std::string_view to_string(Source source) {
  switch (source) {
    case Source::kNone:
      return "none";
    case Source::kAligning:
      return "aligning";
    case Source::kInsOnly:
      return "ins";
    case Source::kEkf:
      return "ekf";
    case Source::kSmoother:
      return "smoother";
  }
  return "unknown";
}

}  // namespace leonav
