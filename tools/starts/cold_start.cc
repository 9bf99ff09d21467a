#include "tools/starts/cold_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "tools/evaluate/errors.h"

namespace leonav {
namespace {

constexpr double kJudged_s = 10.0;       // over which the motion is classified
constexpr double kStandingSpeed = 0.02;  // m/s, at most
constexpr double kDrivingSpeed = 3.0;    // m/s, at least
constexpr double kReverseSpeed = 0.5;    // m/s, at least
constexpr double kStraightTurn = 3.0 * std::numbers::pi / 180.0;
constexpr double kCurveTurn = 20.0 * std::numbers::pi / 180.0;
constexpr double kLater_s = 30.0;
constexpr double kWalkingSpeed = 1.5;   // m/s
constexpr double kLeastDrive_s = 11.0;  // a course's six seconds, three to confirm it, and the ends

}  // namespace

std::string_view to_string(InitialMotion way) {
  switch (way) {
    case InitialMotion::kStanding:
      return "standing";
    case InitialMotion::kStraight:
      return "straight on";
    case InitialMotion::kCurve:
      return "in a curve";
    case InitialMotion::kReverse:
      return "in reverse";
    case InitialMotion::kOther:
      return "other";
  }
  return "unknown";
}

bool cannot_align(const StartResult& result) {
  if (result.with_gnss_30_s < kLeastDrive_s) return true;
  return !result.gyros_find_north && result.driven_30_s < kLeastDrive_s;
}

std::optional<TrueMotion> motion_at(const Track& truth, GpsTime time) {
  const auto point = truth_at(truth, time, ErrorOptions{}.max_truth_gap_s);
  if (!point || !point->rpy[2] || !point->v_n) return std::nullopt;
  const double yaw = *point->rpy[2];
  const Eigen::Vector2d v = point->v_n->head<2>();
  return TrueMotion{yaw, v.norm(), v.dot(Eigen::Vector2d(std::cos(yaw), std::sin(yaw)))};
}

InitialMotion initial_motion_at(const Track& truth, GpsTime start) {
  double slowest = 1e9, fastest = 0.0, turned = 0.0, last_yaw = 0.0, forward = 0.0;
  for (int i = 0; i <= static_cast<int>(kJudged_s); ++i) {
    const auto motion = motion_at(truth, start.plus_seconds(i));
    if (!motion) return InitialMotion::kOther;
    slowest = std::min(slowest, motion->speed);
    fastest = std::max(fastest, motion->speed);
    forward = std::min(forward, motion->forward);
    if (i > 0) turned += std::abs(wrap_to_pi(motion->yaw - last_yaw));
    last_yaw = motion->yaw;
  }
  if (fastest < kStandingSpeed) return InitialMotion::kStanding;
  if (forward < -kReverseSpeed) return InitialMotion::kReverse;
  if (slowest < kDrivingSpeed) return InitialMotion::kOther;
  if (turned < kStraightTurn) return InitialMotion::kStraight;
  return turned > kCurveTurn ? InitialMotion::kCurve : InitialMotion::kOther;
}

namespace {

NavigatorConfig told(NavigatorConfig config, const Track& truth, GpsTime start,
                     std::optional<double> off) {
  const auto motion = motion_at(truth, start);
  if (off && motion) config.alignment.initial_heading = wrap_to_pi(motion->yaw + *off);
  return config;
}

bool find_north(const NavigatorConfig& config, const Track& truth, GpsTime start) {
  const auto point = truth_at(truth, start, ErrorOptions{}.max_truth_gap_s);
  if (!point) return false;
  const double rate = kEarthRotationRate * std::cos(point->position.latitude);
  return config.imu.gyro_bias.sigma < config.alignment.max_gyrocompass_sigma * rate;
}

}  // namespace

ColdStart::ColdStart(const NavigatorConfig& config, const Track& truth, GpsTime start,
                     std::span<const Product> products, std::optional<double> given_heading_error)
    : truth_(truth),
      navigator_(told(config, truth, start, given_heading_error), this),
      dispatch_(&navigator_.sequencer()) {
  result_.start = start;
  result_.way = initial_motion_at(truth, start);
  result_.given_heading_error = given_heading_error;
  result_.gyros_find_north = find_north(config, truth, start);
  for (const Product& product : products) dispatch_.dispatch(product.channel, product.data);
}

void ColdStart::on_event(const Event& event) {
  if (event.kind != EventKind::kFilterReset ||
      event.code != static_cast<std::uint8_t>(ResetCause::kHeading))
    return;
  if (result_.restarts++ > 0) return;
  result_.noticed_after_s = seconds_between(event.time, result_.start);
  result_.noticed_driven_s = result_.driven_s;
  result_.when_noticed = result_.heading.last();
}

void ColdStart::on_epoch(const EpochReport& report) {
  const auto motion = motion_at(truth_, report.time);
  if (!motion) return;
  const double after_s = seconds_between(report.time, result_.start);
  const double since_s = last_.is_set() ? seconds_between(report.time, last_) : 0.0;
  const bool early = after_s <= kLater_s && !report.empty, drives = motion->speed > kWalkingSpeed;
  if (early) result_.with_gnss_30_s += since_s;
  if (early && drives) result_.driven_30_s += since_s;
  if (drives) result_.driven_s += since_s;
  last_ = report.time;
  if (!report.solution.has_attitude) {
    result_.heading.add_without(after_s);
    return;
  }
  result_.heading.add(after_s, wrap_to_pi(report.solution.yaw - motion->yaw),
                      report.solution.sigma_rpy.z());
}

}  // namespace leonav
