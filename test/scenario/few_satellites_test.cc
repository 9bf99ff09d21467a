// Experiments with one to four satellites of a system: the recorded runs under a cap, from the log
// to the error table.
#include <cstdio>
#include <string>

#include "scenario/recorded_runs.h"

namespace leonav::test {
namespace {

std::string capped(int satellites) {
  const std::string n = std::to_string(satellites);
  return " --set gnss.gps.max_satellites=" + n + " --set gnss.galileo.max_satellites=" + n;
}

}  // namespace

// With an IMU every satellite is worth something: the error grows as they become fewer, and the
// filter knows.
TEST_CASE("the drive with an IMU and one to four satellites of each system") {
  if (!programs() || !have_shared_data("drive/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const std::string truth = place.beside("truth_attitude.csv");
  const std::string log = semi_real_log(place, truth);
  const double bound_m[] = {5000.0, 40.0, 8.0, 2.0};  // consumer grade, 33 minutes
  double fewer_m = 1e9;
  for (int n = 1; n <= 4; ++n) {
    const Errors errors =
        errors_of(place, log, config("phone_imu") + capped(n), "--truth " + truth);
    std::printf("drive with IMU, GPS and Galileo capped at %d: horizontal RMSE %.2f m\n", n,
                errors.rmse);
    CAPTURE(n);
    CHECK(errors.answered == 1985);
    CHECK(errors.rmse < bound_m[n - 1]);
    CHECK(errors.rmse < fewer_m);
    CHECK(errors.within > 0.98);
    fewer_m = errors.rmse;
  }
}

// Without, and with its position free at every epoch, two of each system are too few, and one more
// is enough.
TEST_CASE("the station, free to move, with one to four satellites of each system") {
  if (!programs() || !have_shared_data("station/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "station");
  const TemporaryFile truth("truth.csv", station_truth());
  const double bound_m[] = {10.0, 30.0, 0.3, 0.1};
  for (int n = 1; n <= 4; ++n) {
    const Errors errors =
        errors_of(place, log, config("station") + free_to_move() + capped(n),
                  "--max-truth-gap 1e9 --from 2111:349200 --truth " + truth.path());
    std::printf("station, free to move, GPS and Galileo capped at %d: horizontal RMSE %.3f m\n", n,
                errors.rmse);
    CAPTURE(n);
    CHECK(errors.answered == 601);  // of the last five hours
    CHECK(errors.rmse < bound_m[n - 1]);
    CHECK(errors.within > 0.98);
  }
}

}  // namespace leonav::test
