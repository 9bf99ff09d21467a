// What leonav answers on the recorded data, from the files to the error table: the bounds that its
// users are promised. Each configuration as shipped.
#include <cstdio>
#include <string>

#include "scenario/recorded_runs.h"

namespace leonav::test {

TEST_CASE("the recorded walk: two decimetres against its track, within the stated sigma") {
  if (!programs() || !have_shared_data("walk/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "walk");
  const std::string judge = "--remove-offset --truth " + shared_data("walk/truth.csv");
  const Errors with = errors_of(place, log, config("walk"), judge);
  const Errors without = errors_of(place, log, config("walk") + " --set ekf.carrier=false", judge);
  const Errors smoother =
      errors_of(place, log, config("walk") + " --set estimator=smoother", judge);
  std::printf("walk: horizontal RMSE %.3f m, without carriers %.3f m, smoother %.3f m\n", with.rmse,
              without.rmse, smoother.rmse);
  for (const Errors& errors : {with, smoother}) CHECK(errors.answered >= 535);
  CHECK(with.rmse < 0.2);
  CHECK(with.within > 0.98);
  CHECK(without.rmse < 1.0);
  CHECK(smoother.rmse < 0.2);
  CHECK(smoother.within > 0.98);
}

TEST_CASE(
    "the recorded drive: every epoch answered, what the smoother adds, and each part of the "
    "filter") {
  if (!programs() || !have_shared_data("drive/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "drive");
  const std::string judge = "--truth " + shared_data("drive/truth.csv");
  const Errors shipped = errors_of(place, log, config("phone"), judge);
  const std::string by_filter = config("phone") + " --set estimator=ekf";
  const Errors filter = errors_of(place, log, by_filter, judge);
  const Errors codes = errors_of(place, log, by_filter + " --set ekf.carrier=false", judge);
  const Errors trusting = errors_of(place, log, by_filter + " --set robust.enabled=false", judge);
  std::printf(
      "drive: horizontal RMSE %.3f m, 95 %% %.3f m; filter %.3f m, %.3f m; without carriers %.3f "
      "m; "
      "not robust %.3f m\n",
      shipped.rmse, shipped.p95, filter.rmse, filter.p95, codes.rmse, trusting.rmse);
  for (const Errors& errors : {shipped, filter, codes, trusting}) CHECK(errors.answered == 1985);
  CHECK(shipped.rmse < 1.6);
  CHECK(shipped.p95 < 2.5);
  CHECK(shipped.rmse <= filter.rmse);
  for (const Errors& errors : {shipped, filter}) CHECK(errors.within > 0.98);
  CHECK(filter.rmse < 1.75);
  CHECK(filter.p95 < 3.5);
  CHECK(filter.rmse <= codes.rmse);
  CHECK(filter.rmse < trusting.rmse);
}

TEST_CASE("the recorded station: centimetres, its position free at every epoch") {
  if (!programs() || !have_shared_data("station/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const std::string log = imported(place, "station");
  const TemporaryFile truth("truth.csv", station_truth());
  const std::string out = place.beside("result"), json = place.beside("errors.json");
  const ProgramRun replay = run_program(
      "leonav-replay", config("station") + free_to_move() + " --out " + out + " " + log);
  REQUIRE(replay.exit_code == 0);
  const std::string judge = "--truth " + truth.path() +
                            " --max-truth-gap 1e9 --convergence-bound 0.1 --json " + json + " " +
                            out + "/solution.csv";
  REQUIRE(run_program("leonav-eval", judge).exit_code == 0);
  const double settled_s = number_after(text_of(json), "", "settled_s");
  REQUIRE(run_program("leonav-eval", "--from 2111:349200 " + judge).exit_code == 0);
  const double rmse = number_after(text_of(json), "3d_m", "rmse");
  std::printf(
      "station, kinematic: below 0.1 m for good after %.0f s, 3D RMSE from minute 60 %.3f m\n",
      settled_s, rmse);
  CHECK(settled_s > 0.0);
  CHECK(settled_s <= 1200.0);
  CHECK(rmse <= 0.045);
}

}  // namespace leonav::test
