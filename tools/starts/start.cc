#include "start.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/earth/rotation.h"
#include "tools/evaluation/errors.h"

namespace leonav {
namespace {

constexpr double kJudged_s = 10.0;       // of the way
constexpr double kStandingSpeed = 0.02;  // m/s, at most
constexpr double kDrivingSpeed = 3.0;    // at least
constexpr double kStraightTurn = 3.0 * std::numbers::pi / 180.0;
constexpr double kCurveTurn = 20.0 * std::numbers::pi / 180.0;
constexpr double kLater_s = 30.0;

}  // namespace

std::string_view to_string(Way way) {
  switch (way) {
    case Way::kStanding:
      return "standing";
    case Way::kStraight:
      return "straight on";
    case Way::kCurve:
      return "in a curve";
    case Way::kOther:
      return "other";
  }
  return "unknown";
}

std::optional<TrueMotion> motion_at(const Track& truth, GpsTime time) {
  const auto point = truth_at(truth, time, ErrorOptions{}.max_truth_gap_s);
  if (!point || !point->rpy[2] || !point->v_n) return std::nullopt;
  return TrueMotion{*point->rpy[2], point->v_n->head<2>().norm()};
}

Way way_at(const Track& truth, GpsTime start) {
  double slowest = 1e9, fastest = 0.0, turned = 0.0, last_yaw = 0.0;
  for (int i = 0; i <= static_cast<int>(kJudged_s); ++i) {
    const auto motion = motion_at(truth, start.plus_seconds(i));
    if (!motion) return Way::kOther;
    slowest = std::min(slowest, motion->speed);
    fastest = std::max(fastest, motion->speed);
    if (i > 0) turned += std::abs(wrap_to_pi(motion->yaw - last_yaw));
    last_yaw = motion->yaw;
  }
  if (fastest < kStandingSpeed) return Way::kStanding;
  if (slowest < kDrivingSpeed) return Way::kOther;
  if (turned < kStraightTurn) return Way::kStraight;
  return turned > kCurveTurn ? Way::kCurve : Way::kOther;
}

Start::Start(const NavigatorConfig& config, const Track& truth, GpsTime start,
             std::span<const Product> products)
    : truth_(truth), pipeline_(config, this), dispatch_(&pipeline_.sequencer()) {
  result_.start = start;
  result_.way = way_at(truth, start);
  for (const Product& product : products) dispatch_.dispatch(product.channel, product.data);
}

void Start::on_epoch(const EpochReport& report) {
  if (!report.solution.has_attitude) return;
  const auto motion = motion_at(truth_, report.time);
  if (!motion) return;
  const double after_s = seconds_between(report.time, result_.start);
  const double error = wrap_to_pi(report.solution.yaw - motion->yaw);
  const double sigma = report.solution.sigma_rpy.z();
  if (result_.aligned_after_s < 0.0) {
    result_.aligned_after_s = after_s;
    result_.error_when_aligned = error;
    result_.sigma_when_aligned = sigma;
  }
  if (after_s > kLater_s + 0.5) return;
  result_.error_at_30_s = error;
  result_.sigma_at_30_s = sigma;
}

}  // namespace leonav
