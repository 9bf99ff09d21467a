#include "core/navigator/interface/decision.h"

namespace leonav {

Decision decision_of(const SmootherReport& report) {
  Decision decision;
  decision.epoch = report.index;
  decision.subject = Decision::Subject::kSmoother;
  decision.committed = true;
  decision.iterations = report.iterations;
  return decision;
}

}  // namespace leonav
