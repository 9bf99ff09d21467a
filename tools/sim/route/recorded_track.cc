#include "tools/sim/route/recorded_track.h"

#include <cmath>
#include <optional>
#include <utility>

#include "core/earth/rotation.h"
#include "tools/sim/motion/smooth_track.h"
#include "tools/sim/route/lean.h"

namespace leonav::sim {
namespace {

constexpr double kMinSpeed = 1.0;  // m/s; below, the direction of motion is not defined

using Angle = std::optional<double> TruthPoint::*;

// Returns the unwrapped angles; empty unless every point has one.
std::vector<double> recorded(const std::vector<TruthPoint>& points, Angle angle) {
  std::vector<double> values;
  for (const TruthPoint& point : points) {
    if (!(point.*angle)) return {};
    const double now = *(point.*angle);
    values.push_back(values.empty() ? now : values.back() + wrap_to_pi(now - values.back()));
  }
  return values;
}

PathMotion path_motion(const MotionInstant& now) {
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(now.p_e));
  const Eigen::Vector3d v = C_ne * now.v_e, a = C_ne * now.a_e;
  PathMotion path;
  path.speed_m_s = std::hypot(v.x(), v.y());
  if (path.speed_m_s < kMinSpeed) return path;
  path.lateral_m_s2 = (v.x() * a.y() - v.y() * a.x()) / path.speed_m_s;
  path.along_m_s2 = (v.x() * a.x() + v.y() * a.y()) / path.speed_m_s;
  return path;
}

}  // namespace

SplineMotion recorded_track(const RouteConfig& route) {
  SmoothTrackOptions options;
  options.max_gap_s = route.max_gap_s;
  const SmoothTrack track(route.track, options);
  const SplineMotion& motion = track.motion();
  MotionSplines splines = motion.splines();
  std::vector<double> times, roll, pitch;
  for (const TruthPoint& point : route.track) {
    times.push_back(seconds_between(point.time, motion.start()));
    PathMotion path = path_motion(motion.at(times.back()));
    path.slope = splines.attitude[1].evaluate(times.back()).value;
    const Lean lean = lean_of(route.vehicle, path);
    roll.push_back(lean.roll);
    pitch.push_back(lean.pitch);
  }
  const double lambda = SmoothingSpline::lambda_for_cutoff(
      options.attitude_cutoff_hz, splines.duration_s / static_cast<double>(times.size() - 1));
  if (const auto of_file = recorded(route.track, &TruthPoint::roll); !of_file.empty())
    roll = of_file;
  if (const auto of_file = recorded(route.track, &TruthPoint::pitch); !of_file.empty())
    pitch = of_file;
  splines.attitude[0] = SmoothingSpline(times, roll, lambda);
  splines.attitude[1] = SmoothingSpline(times, pitch, lambda);
  if (const auto yaw = recorded(route.track, &TruthPoint::yaw); !yaw.empty())
    splines.attitude[2] = SmoothingSpline(times, yaw, lambda);
  return SplineMotion(std::move(splines));
}

}  // namespace leonav::sim
