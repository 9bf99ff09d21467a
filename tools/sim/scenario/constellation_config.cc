#include "tools/sim/scenario/constellation_config.h"

#include <numbers>

namespace leonav::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Bounds kAngle = {-360.0, 360.0}, kSigma = {0.0, 1e3};

void read_shell(ConfigReader& group, ConstellationConfig* c) {
  OrbitShell shell;
  group.integer("planes", 1, 100, &shell.planes);
  group.integer("per_plane", 1, 100, &shell.per_plane);
  group.number("semi_major_axis_km", {6500.0, 1e5}, &shell.semi_major_axis_m, 1e3);
  group.number("eccentricity", {0.0, 0.5}, &shell.eccentricity);
  group.number("inclination_deg", {0.0, 180.0}, &shell.inclination, kDegree);
  group.number("node_span_deg", {0.0, 360.0}, &shell.node_span, kDegree);
  group.number("first_node_deg", kAngle, &shell.first_node, kDegree);
  group.number("phase_per_plane_deg", kAngle, &shell.phase_per_plane, kDegree);
  group.number("first_anomaly_deg", kAngle, &shell.first_anomaly, kDegree);
  if (shell.semi_major_axis_m == 0.0) group.fail("semi_major_axis_km", "must be given");
  c->shells.push_back(shell);
}

}  // namespace

void read_constellation(ConfigReader& group, ConstellationConfig* c) {
  group.boolean("enabled", &c->enabled);
  group.integer("first_number", 1, 399, &c->first_number);
  group.number("orbit_error_m", kSigma, &c->orbit_error_m);
  group.number("clock_error_m", kSigma, &c->clock_error_m);
  group.number("node_interval_s", {1.0, 900.0}, &c->node_interval_s);
  group.number("clock_interval_s", {1.0, 900.0}, &c->clock_interval_s);
  ConstellationConfig own;
  if (group.groups("shells", [&](ConfigReader& r) { read_shell(r, &own); })) c->shells = own.shells;
}

}  // namespace leonav::sim
