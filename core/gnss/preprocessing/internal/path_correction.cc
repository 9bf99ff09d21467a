#include "core/gnss/preprocessing/internal/path_correction.h"

#include "core/gnss/measurement/weighting.h"
#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/propagation/phase_wind_up.h"
#include "core/gnss/propagation/shapiro.h"

namespace leonav {
namespace {

Eigen::Matrix3d axes_of(const DelayContext& context, const SatelliteInView& satellite) {
  return satellite_axes(satellite.p_e, satellite.v_e, context.p_sun_e,
                        attitude_law(satellite.satellite, context.config->leo_attitude));
}

// Mixes the identities of several patterns, in their order, into one number (FNV-1a).
std::uint32_t mixed(std::uint32_t issue, std::uint64_t revision) {
  return (issue ^ static_cast<std::uint32_t>(revision)) * 16777619u;
}

}  // namespace

double path_delay_m(const DelayContext& context, const Eigen::Vector3d& p_a_e,
                    const SatelliteInView& satellite) {
  if (!context.has_position) return 0.0;
  const Eigen::Vector3d u = (satellite.p_e - p_a_e).normalized();
  return shapiro_delay_m(satellite.p_e, p_a_e) - u.dot(context.tide_e);
}

double wind_up_cycles(const DelayContext& context, const SatelliteInView& satellite,
                      double previous) {
  return phase_wind_up_cycles(satellite.p_e, axes_of(context, satellite), to_ecef(context.antenna),
                              context.C_er, previous);
}

AntennaCorrection antenna_range(const DelayContext& context, const SatelliteInView& satellite,
                                SignalCode first, SignalCode second) {
  const bool is_mass_centre = !satellite.at_antenna;
  AntennaCorrection correction;
  if (context.antennas == nullptr || !context.has_position) {
    correction.known = !is_mass_centre;
    return correction;
  }
  const System system = satellite.satellite.system;
  const Eigen::Vector3d p_a_e = to_ecef(context.antenna);
  const Eigen::Matrix3d C_es = axes_of(context, satellite);
  const Eigen::Vector3d u_r = context.C_er.transpose() * (satellite.p_e - p_a_e).normalized();
  const auto add = [&](char band, double gamma) {
    const AntennaRange receiver = context.antennas->receiver_range(system, band, u_r);
    correction.range_m += gamma * receiver.range_m;
    correction.issue = mixed(correction.issue, receiver.revision);
    if (!is_mass_centre) return;
    const AntennaRange range = context.antennas->satellite_range(
        satellite.satellite, band, context.time, satellite.p_e, C_es, p_a_e);
    correction.range_m += gamma * range.range_m;
    correction.issue = mixed(correction.issue, range.revision);
    if (range.status == AntennaStatus::kNone) correction.known = false;
  };
  if (second.band == 0) {
    add(first.band, 1.0);
  } else {
    const IonosphereFree pair =
        ionosphere_free(context.config->bands.frequency_hz(system, first.band),
                        context.config->bands.frequency_hz(system, second.band));
    add(first.band, pair.gamma1);
    add(second.band, pair.gamma2);
  }
  return correction;
}

}  // namespace leonav
