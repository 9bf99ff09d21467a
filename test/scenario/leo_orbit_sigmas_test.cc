// LEO satellites whose told orbits and clocks are wrong by centimetres: a receiver under an open
// sky knows how far off they put it. From seed to seed the errors differ; these are among the
// worst.
#include <cstdio>
#include <string>

#include "scenario/recorded_runs.h"

namespace leonav::test {
namespace {

constexpr const char* kAntennaIsPoint = " --set 'vehicle.lever_arm_b_m=[0, 0, 0]'";

// Share of the epochs from ten minutes on whose north, east and up lie within three sigma.
double within_three_sigma(const TemporaryFile& place, int seed, const std::string& systems) {
  const std::string log = place.beside("run.lcmlog");
  const ProgramRun sim =
      run_program("leonav-sim", "'" LEONAV_SOURCE_DIR "/config/scenario/open_sky.yaml' -o '" + log +
                                    "' --set seed=" + std::to_string(seed) +
                                    " --set satellites.advance_s=" + std::to_string(7001 * seed) +
                                    " --set duration_s=1202 --set places=none --set "
                                    "imu.enabled=false --set route.standing_s=2000 --set "
                                    "'receiver.lever_arm_b_m=[0, 0, 0]'");
  INFO(sim.err);
  REQUIRE(sim.exit_code == 0);
  errors_of(place, log,
            config("urban") + kAntennaIsPoint + " --set ekf.motion=static --set gnss.systems='[" +
                systems + "]' --set ekf.code_correlation_time_s=60",
            "--truth '" + place.beside("truth.csv") + "' --from 2136:346200");
  return number_after(text_of(place.beside("errors.json")), "", "within_three_sigma");
}

}  // namespace

TEST_CASE("what LEO's orbits are off by is in the stated sigmas") {
  if (!programs() || !have_programs("leonav-sim")) return;
  const TemporaryFile place("unused", "");
  for (const int seed : {2, 4})
    for (const char* systems : {"gps, leo", "gps, galileo, beidou, leo"}) {
      const double share = within_three_sigma(place, seed, systems);
      std::printf("seed %d, %s: %.2f %% within three sigma\n", seed, systems, 100.0 * share);
      CHECK(share > 0.99);
    }
}

}  // namespace leonav::test
