// Real satellites from files, judged by the readers and models that the daemon uses.
#include "tools/sim/sky/real_orbits.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/gnss/orbits/precise_orbit.h"
#include "core/gnss/orbits/satellite_state.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"
#include "tools/sim/scenario/scenario_yaml.h"
#include "tools/sim/sky/true_sky.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

const GpsTime kMorning = GpsTime::from_week_and_tow(2111, 345'600.0 + 6.0 * 3600.0);
const char* const kSp3 = "station/GRG0MGXFIN_2020177_15M.sp3";
const char* const kNav = "station/ESBC00DNK_2020177.nav";

Eigen::Vector3d p_e(const RealOrbit& orbit, double t) { return to_earth(orbit.orbit.at(t).p_i, t); }

}  // namespace

TEST_CASE("Satellites of an SP3 file are where the file has them") {
  if (!test::have_shared_data(kSp3)) return;
  const std::string path = test::shared_data(kSp3);
  const auto orbits = load_real_orbits(path, System::kGps, {kMorning, -14'700.0, 18'300.0});
  CHECK(orbits.size() > 25);
  double worst = 0.0;
  int compared = 0;
  for (const Sp3Epoch& epoch : read_sp3(path).epochs) {
    const double t = seconds_between(epoch.time, kMorning);
    if (std::abs(t) > 14'000.0) continue;
    for (const PreciseState& state : epoch.states) {
      for (const RealOrbit& orbit : orbits) {
        if (orbit.satellite != state.satellite) continue;
        worst = std::max(worst, (p_e(orbit, t) - state.p_e).norm());
        ++compared;
      }
    }
  }
  INFO("worst of " << compared << ": " << worst << " m");
  CHECK(compared > 700);
  CHECK(worst < 0.005);
}

TEST_CASE("Where a file ends satellites go on without a break") {
  if (!test::have_shared_data(kSp3)) return;
  const std::string path = test::shared_data(kSp3);
  // The last node is at 23:45.
  const GpsTime evening = GpsTime::from_week_and_tow(2111, 345'600.0 + 23.0 * 3600.0);
  for (const RealOrbit& orbit :
       load_real_orbits(path, System::kGps, {evening, -7200.0, 14'700.0})) {
    for (double t = -7000.0; t < 14'000.0; t += 97.0) {
      const OrbitState a = orbit.orbit.at(t), b = orbit.orbit.at(t + 1.0);
      const Eigen::Vector3d step = b.p_i - a.p_i - 0.5 * (a.v_i + b.v_i);
      REQUIRE(step.norm() < 1e-4);
    }
  }
}

TEST_CASE("Satellites that go on beyond a file stay near their orbits") {
  if (!test::have_shared_data(kSp3)) return;
  const std::string path = test::shared_data(kSp3);
  // The same with and without the file's last two and a half hours.
  std::ifstream whole(path);
  std::string text, line;
  while (std::getline(whole, line) && !line.starts_with("*  2020  6 25 21 15")) text += line + "\n";
  const test::TemporaryFile cut("cut.sp3", text + "EOF\n");
  const GpsTime evening = GpsTime::from_week_and_tow(2111, 345'600.0 + 19.0 * 3600.0);
  const OrbitSpan span{evening, -7200.0, 14'700.0};
  const auto truth = load_real_orbits(path, System::kGps, span);
  const auto gone_on = load_real_orbits(cut.path(), System::kGps, span);
  REQUIRE(truth.size() == gone_on.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // The last node left is of 21:00, two hours before: what the model leaves
    // are what is left.
    const double miss = (p_e(truth[i], 14'400.0) - p_e(gone_on[i], 14'400.0)).norm();
    UNSCOPED_INFO(to_string(truth[i].satellite) << ": " << miss << " m");
    worst = std::max(worst, miss);
  }
  INFO(worst << " m after two hours");
  CHECK(worst < 25.0);
  CHECK(worst > 0.01);
}

TEST_CASE("Satellites of a navigation file are where their elements say, without steps") {
  if (!test::have_shared_data(kNav)) return;
  const std::string path = test::shared_data(kNav);
  const OrbitSpan span{kMorning, -14'700.0, 18'300.0};
  for (const System system : {System::kGps, System::kGalileo, System::kBeidou}) {
    const auto orbits = load_real_orbits(path, system, span);
    INFO(to_string(system));
    CHECK(orbits.size() > 5);
    double worst = 0.0;
    for (const Ephemeris& e : read_navigation(path).ephemerides) {
      const double t = seconds_between(e.toe, kMorning);
      if (std::abs(t) > 7200.0 || e.message == NavigationMessage::kGalileoFnav) continue;
      for (const RealOrbit& orbit : orbits) {
        if (orbit.satellite != e.satellite) continue;
        worst = std::max(worst, (p_e(orbit, t) - broadcast_state(e, e.toe).p_e).norm());
      }
    }
    // Of two issues of one toe, and of Galileo's two messages, one is taken.
    CHECK(worst < 3.0);
    for (const RealOrbit& orbit : orbits) {
      for (double t = -7000.0; t < 10'000.0; t += 97.0) {
        const OrbitState a = orbit.orbit.at(t), b = orbit.orbit.at(t + 1.0);
        REQUIRE((b.p_i - a.p_i - 0.5 * (a.v_i + b.v_i)).norm() < 1e-3);
      }
    }
  }
}

TEST_CASE("A start outside the file is an error that says so") {
  if (!test::have_shared_data(kSp3)) return;
  const GpsTime later = kMorning.plus_seconds(5.0 * 86'400.0);
  CHECK_THROWS_WITH(
      load_real_orbits(test::shared_data(kSp3), System::kGps, {later, -7200.0, 7200.0}),
      Catch::Contains(".sp3") && Catch::Contains("start_gps_week"));
  CHECK_THROWS_WITH(
      load_real_orbits(test::shared_data(kNav), System::kGps, {later, -7200.0, 7200.0}),
      Catch::Contains(".nav") && Catch::Contains("start_gps_week"));
}

TEST_CASE("A file beside the scenario is found, one that is not there is an error") {
  const test::TemporaryFile scenario("scenario.yaml", "satellites: {gps: {file: none.sp3}}\n");
  const Scenario read = load_scenario(scenario.path());
  CHECK(read.constellations[index_of(System::kGps)].file == scenario.beside("none.sp3"));
  CHECK_THROWS_WITH(build_sky(read), Catch::Contains("none.sp3"));
  CHECK_THROWS_WITH(load_scenario_text("satellites: {leo: {file: a.sp3}}\n", "s.yaml"),
                    Catch::Contains("low satellites"));
}
