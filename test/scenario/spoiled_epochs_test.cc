// The recorded station with a few epochs in which codes and carriers are wrong by the same metres,
// or whose time stamps are: what is right again must be believed again, and what remains of the
// damage must show in the stated sigma.
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>

#include "core/gnss/signals/band_plan.h"
#include "scenario/edited_log.h"
#include "scenario/recorded_runs.h"

namespace leonav::test {
namespace {

constexpr double kFirst_s = 360'450.0;  // time of week of the first spoiled epoch, 4 h into the run
constexpr double kInterval_s = 30.0;

struct Spoiled {
  const char* what;
  int epochs;
  std::function<bool(SatelliteId)> is_hit;
  double noise_m;  // 1 sigma, another for each satellite and epoch, codes and carriers alike
  double late_s;   // of the time stamp
  double free_m, standing_m;  // largest 3D error from ten minutes later on
};

bool any(SatelliteId) { return true; }
bool gps(SatelliteId satellite) { return satellite.system == System::kGps; }
bool galileo(SatelliteId satellite) { return satellite.system == System::kGalileo; }
bool even(SatelliteId satellite) { return satellite.number % 2 == 0; }

// Undisturbed it is 0.07 m free and 0.05 m standing.
const Spoiled kSpoiled[] = {
    {"GPS, 7 km", 1, gps, 7155.0, 0.0, 0.1, 0.1},
    {"GPS, 100 m", 1, gps, 100.0, 0.0, 0.1, 0.1},
    {"half, 9 km", 1, even, 9000.0, 0.0, 0.1, 0.1},
    {"all, 10 m", 1, any, 10.0, 0.0, 0.1, 0.1},
    {"all, 70 m", 3, any, 70.0, 0.0, 0.15, 0.1},
    {"Galileo, 5 m", 2, galileo, 5.0, 0.0, 0.15, 0.1},
    {"stamp 50 ms late", 1, any, 0.0, 0.05, 0.1, 0.1},
    {"stamp 100 ms late", 1, any, 0.0, 0.1, 0.1, 0.1},
    {"stamps 100 ms late", 3, any, 0.0, 0.1, 0.15, 0.1},
    {"stamps 20 ms late", 3, any, 0.0, 0.02, 0.15, 0.1},
    {"stamps 10 ms late", 3, any, 0.0, 0.01, 0.15, 0.1},
    {"stamps 5 ms late", 3, any, 0.0, 0.005, 0.15, 0.1},
    {"stamps 1 ms late", 3, any, 0.0, 0.001, 0.1, 0.1},
};

auto spoil(const Spoiled& how) {
  std::mt19937_64 generator(1);
  return [how, generator](int, RawEpoch* epoch) mutable {
    std::normal_distribution<double> normal;
    const double since_s = epoch->time.tow_s() - kFirst_s;
    if (since_s < -1.0 || since_s > kInterval_s * how.epochs - 1.0) return true;
    SatelliteId last;
    double off_m = 0.0;
    for (SignalObservation& o : epoch->observations) {
      if (!(o.satellite == last)) off_m = how.noise_m * normal(generator);
      last = o.satellite;
      if (!how.is_hit(o.satellite)) continue;
      o.pseudorange_m += off_m;
      o.carrier_cycles += off_m / BandPlan().wavelength_m(o.satellite.system, o.code.band);
    }
    epoch->time = epoch->time.plus_seconds(how.late_s);
    return true;
  };
}

// The reference is as uncertain as a standing receiver's solution, so that sigmas are judged of the
// free one only.
double worst_later_m(const TemporaryFile& place, const std::string& log, const std::string& truth,
                     const std::string& options) {
  const bool standing = options.empty();
  errors_of(
      place, log, config("station") + options,
      "--max-truth-gap 1e9 --truth " + truth + " --from 2111:" + std::to_string(kFirst_s + 600.0));
  const std::string errors = text_of(place.beside("errors.json"));
  CHECK((standing || number_after(errors, "", "within_three_sigma") > 0.99));
  return number_after(errors, "3d_m", "worst");
}

}  // namespace

TEST_CASE("a few spoiled epochs at the station do not spoil the hours after them") {
  if (!programs() || !have_shared_data("station/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const TemporaryFile truth("truth.csv",
                            "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m\n"
                            "2111,345600,55.4935676124,8.4568295850,59.4606\n"
                            "2111,432000,55.4935676124,8.4568295850,59.4606\n");
  const std::string log = imported(place, "station");
  const std::string free =
      " --set ekf.motion=constant_velocity"
      " --set ekf.acceleration_noise_horizontal_m_s2_per_sqrt_hz=100"
      " --set ekf.acceleration_noise_vertical_m_s2_per_sqrt_hz=100";
  for (const Spoiled& how : kSpoiled) {
    const std::string spoiled = edited(place, log, spoil(how));
    const double free_m = worst_later_m(place, spoiled, truth.path(), free);
    const double standing_m = worst_later_m(place, spoiled, truth.path(), "");
    std::printf("station, %s, %d epochs: 3D at most %.3f m free, %.3f m standing, from 10 min on\n",
                how.what, how.epochs, free_m, standing_m);
    CAPTURE(how.what);
    CHECK(free_m < how.free_m);
    CHECK(standing_m < how.standing_m);
  }
}

}  // namespace leonav::test
