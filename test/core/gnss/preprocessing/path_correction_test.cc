// Which way satellites stand where their antennas and the carriers' wind-up are corrected.
#include "core/gnss/preprocessing/internal/path_correction.h"

#include "core/earth/sun_moon.h"
#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/propagation/phase_wind_up.h"
#include "support/catch.h"
#include "support/sky/simulated_sky.h"

namespace leonav {
namespace {

SatelliteInView in_view(const Ephemeris& ephemeris) {
  const SatelliteState state = broadcast_state(ephemeris, test::kSkyEpoch);
  SatelliteInView satellite;
  satellite.satellite = ephemeris.satellite;
  satellite.p_e = state.p_e;
  satellite.v_e = state.v_e;
  return satellite;
}

}  // namespace

TEST_CASE("LEO satellites stand as configured, all others as they do", "[attitude]") {
  const Eigen::Vector3d p_a_e = to_ecef({0.69, 0.14, 300.0});
  const Eigen::Vector3d sun_e = sun_moon_positions(test::kSkyEpoch).sun_e;
  GnssConfig config = default_gnss_config();
  CHECK(config.leo_attitude == AttitudeLaw::kOrbitNormal);
  int compared = 0;
  for (const test::Walker& walker : {test::gps_walker(), test::leo_walker()}) {
    for (const Ephemeris& ephemeris : test::walker_ephemerides(walker)) {
      const SatelliteInView satellite = in_view(ephemeris);
      if (look_angles(satellite.p_e, p_a_e).elevation < 0.3) continue;
      ++compared;
      double cycles[2];
      for (const AttitudeLaw leo : {AttitudeLaw::kOrbitNormal, AttitudeLaw::kYawSteering}) {
        config.leo_attitude = leo;
        DelayContext context = delay_context(config, KlobucharModel{}, test::kSkyEpoch, p_a_e);
        context.p_sun_e = sun_e;
        const AttitudeLaw law =
            ephemeris.satellite.system == System::kLeo ? leo : AttitudeLaw::kYawSteering;
        cycles[leo == AttitudeLaw::kOrbitNormal ? 0 : 1] = wind_up_cycles(context, satellite, 0.0);
        CHECK(wind_up_cycles(context, satellite, 0.0) ==
              phase_wind_up_cycles(satellite.p_e,
                                   satellite_axes(satellite.p_e, satellite.v_e, sun_e, law), p_a_e,
                                   context.C_er, 0.0));
      }
      const double change = std::abs(cycles[1] - cycles[0]);
      CHECK((ephemeris.satellite.system == System::kLeo ? change > 1e-3 : change == 0.0));
    }
  }
  CHECK(compared > 10);
}

}  // namespace leonav
