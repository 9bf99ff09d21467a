#include "tools/sim/scenario/constellation_config.h"

#include "core/base/angle.h"
#include "daemon/config/config_groups.h"

namespace leonav::sim {
namespace {

constexpr Bounds kAngle = {-360.0, 360.0}, kErrorSigma = {0.0, 1e3};

void read_shell(ConfigReader& group, ConstellationConfig* c) {
  OrbitShell shell;
  shell.node_span = 360.0 * kDegree;  // as in Walker's notation
  group.integer("planes", 1, 100, &shell.planes);
  group.integer("per_plane", 1, 100, &shell.per_plane);
  group.number("semi_major_axis_km", {6500.0, 1e5}, &shell.semi_major_axis_m, 1e3);
  group.number("eccentricity", {0.0, 0.5}, &shell.eccentricity);
  group.number("inclination_deg", {0.0, 180.0}, &shell.inclination, kDegree);
  group.number("node_span_deg", {0.0, 360.0}, &shell.node_span, kDegree);
  group.number("first_node_deg", kAngle, &shell.first_node, kDegree);
  group.number("phase_per_plane_deg", kAngle, &shell.phase_per_plane, kDegree);
  group.number("first_anomaly_deg", kAngle, &shell.first_anomaly, kDegree);
  group.integer("first_number", 1, kHighestNumber[index_of(c->system)], &shell.first_number);
  constexpr double kLowestPerigee_m = 6.5e6;
  if (shell.semi_major_axis_m == 0.0) {
    group.report("semi_major_axis_km", "must be given");
  } else if (shell.semi_major_axis_m * (1.0 - shell.eccentricity) < kLowestPerigee_m) {
    group.report("eccentricity",
                 "takes the orbit below 6500 km from the Earth's centre: "
                 "semi_major_axis_km (1 - eccentricity) must be at least that");
  }
  c->shells.push_back(shell);
}

// The numbers that build_sky() will assign must be valid in leonav and unique.
void check_numbers(const ConfigReader& group, const ConstellationConfig& c) {
  if (c.only_risen) return;  // build_sky() counts
  const int highest = kHighestNumber[index_of(c.system)];
  std::vector<bool> taken(static_cast<std::size_t>(highest) + 1);
  int next = c.first_number;
  for (const OrbitShell& shell : c.shells) {
    if (shell.first_number != 0) next = shell.first_number;
    for (int i = 0; i < shell.planes * shell.per_plane; ++i, ++next) {
      if (next > highest) {
        return group.report(
            "shells", "have satellites beyond number " + std::to_string(highest) +
                          ", the highest of the system; take away satellites, or set only_risen");
      }
      if (taken[static_cast<std::size_t>(next)]) {
        return group.report("shells", "have number " + std::to_string(next) +
                                          " twice; mend first_number of a shell");
      }
      taken[static_cast<std::size_t>(next)] = true;
    }
  }
}

void read_errors(ConfigReader& group, EphemerisErrors* errors) {
  double all = -1.0;
  group.number("orbit_error_m", kErrorSigma, &all);
  if (all >= 0.0) errors->orbit_m.setConstant(all);
  group.number("along_error_m", kErrorSigma, &errors->orbit_m[0]);
  group.number("cross_error_m", kErrorSigma, &errors->orbit_m[1]);
  group.number("radial_error_m", kErrorSigma, &errors->orbit_m[2]);
  group.number("clock_error_m", kErrorSigma, &errors->clock_m);
}

void read_signals(ConfigReader& group, ConstellationConfig* c) {
  std::vector<std::string> names;
  for (const SignalCode signal : c->signals) names.push_back(to_string(signal));
  group.list("signals", &names, "list of two RINEX codes");
  if (names.size() != c->signals.size() || names[0] == names[1]) {
    return group.report("signals", "must be two different RINEX codes, as [9S, 3C]");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto signal = signal_from_string(names[i]);
    if (!signal) {
      group.report("signals", "'" + names[i] + "' is no RINEX code: a band 1 to 9 and a letter");
    } else if (!(c->bands.frequency_hz(c->system, signal->band) > 0.0)) {
      group.report("signals", "'" + names[i] + "' is on a band without a carrier: give bands_mhz." +
                                  signal->band + " in MHz");
    }
    if (signal) c->signals[i] = *signal;
  }
}

}  // namespace

void read_constellation(ConfigReader& group, ConstellationConfig* c) {
  group.boolean("enabled", &c->enabled);
  group.integer("first_number", 1, kHighestNumber[index_of(c->system)], &c->first_number);
  group.boolean("only_risen", &c->only_risen);
  group.text("file", &c->file);
  if (!c->file.empty() && c->system == System::kLeo) {
    group.report("file", "is for GPS, Galileo and BeiDou; give shells for low satellites");
  }
  group.choice<ProvidedProducts>("told",
                                 {{"precise", ProvidedProducts::kPrecise},
                                  {"broadcast", ProvidedProducts::kBroadcast},
                                  {"both", ProvidedProducts::kBoth}},
                                 &c->provided);
  read_errors(group, &c->precise);
  group.number("clock_error_varying_m", kErrorSigma, &c->precise.clock_varying_m);
  group.number("product_update_s", {0.0, 86'400.0}, &c->precise.update_s);
  group.number("node_interval_s", {1.0, 900.0}, &c->node_interval_s);
  group.number("clock_interval_s", {1.0, 900.0}, &c->clock_interval_s);
  group.number("group_delay_m", {0.0, 30.0}, &c->group_delay_m);
  group.group("broadcast", [c](ConfigReader& r) {
    // Elements describe a low orbit for some minutes.
    const bool low = c->system == System::kLeo;
    r.number("issue_interval_s", {low ? 60.0 : 600.0, low ? 1800.0 : 7200.0},
             &c->broadcast.issue_interval_s);
    read_errors(r, &c->broadcast.errors);
  });
  group.group("clock", [c](ConfigReader& r) {
    r.number("offset_s", {0.0, 1e-3}, &c->clock.offset_s);
    r.number("drift", {0.0, 1e-8}, &c->clock.drift);
    r.number("noise_s_per_sqrt_s", {0.0, 1e-9}, &c->clock.noise_s_per_sqrt_s);
    r.number("drift_walk_per_sqrt_s", {0.0, 1e-10}, &c->clock.drift_walk_per_sqrt_s);
  });
  ConstellationConfig own;
  own.system = c->system;
  if (group.groups("shells", [&](ConfigReader& r) { read_shell(r, &own); })) c->shells = own.shells;
  check_numbers(group, *c);
  if (c->system != System::kLeo) return;
  read_leo_bands(group, "bands_mhz", &c->bands);
  read_signals(group, c);
}

}  // namespace leonav::sim
