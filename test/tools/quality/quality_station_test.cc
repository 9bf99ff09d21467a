// The recorded station against programs that share nothing with the project: RTKLIB for directions
// and geometry, a script of its own for code multipath.
#include <Eigen/Core>
#include <cmath>
#include <sstream>

#include "core/base/angle.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "support/programs/program_run.h"
#include "support/recorded/rtklib_single.h"
#include "tools/import/dataset.h"
#include "tools/import/import.h"
#include "tools/quality/internal/sky.h"
#include "tools/quality/quality.h"

using namespace leonav;
using namespace leonav::test;

namespace {

constexpr char kObservations[] = "station/ESBC00DNK_2020177_6H_30S.obs";
constexpr char kNavigation[] = "station/ESBC00DNK_2020177.nav";

void import_station(const std::string& path) {
  import_dataset(load_dataset(shared_data("station/dataset.yaml")), {}, path, nullptr);
}

// Kaplan and Hegarty, Understanding GPS, 7.3, one clock.
Dop direct_dop(const std::vector<RtklibResidual>& satellites) {
  Eigen::MatrixXd h(static_cast<Eigen::Index>(satellites.size()), 4);
  for (Eigen::Index i = 0; i < h.rows(); ++i) {
    const RtklibResidual& s = satellites[static_cast<std::size_t>(i)];
    const double a = s.azimuth_deg * kDegree, e = s.elevation_deg * kDegree;
    h.row(i) << -std::cos(e) * std::cos(a), -std::cos(e) * std::sin(a), -std::sin(e), 1.0;
  }
  const Eigen::MatrixXd q = dense::inverse(h.transpose() * h);
  return {std::sqrt(q(0, 0) + q(1, 1) + q(2, 2)), std::sqrt(q(0, 0) + q(1, 1)), std::sqrt(q(2, 2)),
          std::sqrt(q.trace())};
}

}  // namespace

TEST_CASE("station: directions and dilution of precision are RTKLIB's") {
  if (!have_shared_data(kObservations) || !have_rtklib()) return;
  const auto rtklib = run_rtklib({}, kObservations, kNavigation);
  REQUIRE(rtklib.size() > 600);
  const TemporaryFile log("station.lcmlog", "");
  import_station(log.path());
  GnssConfig config = default_gnss_config();
  for (const System system : {System::kGalileo, System::kBeidou, System::kLeo})
    config.systems[index_of(system)].enabled = false;
  Sky sky(config);
  long directions = 0, epochs = 0;
  double worst_deg = 0.0, worst_dop = 0.0;
  const auto compare = [&](const RawEpoch& raw) {
    sky.look(raw);
    const RtklibEpoch* theirs = rtklib_epoch_at(rtklib, raw.time);
    if (theirs == nullptr || !sky.is_solved()) return;
    std::size_t usable = 0, common = 0;
    for (const SatelliteInView& view : sky.epoch().satellites) {
      usable += is_usable(view.reason) ? 1 : 0;
      const RtklibResidual* one = theirs->find(view.satellite);
      if (one == nullptr || !has_direction(view, true)) continue;
      common += is_usable(view.reason) ? 1 : 0;
      const double across = std::cos(view.elevation) *
                            std::remainder(view.azimuth / kDegree - one->azimuth_deg, 360.0);
      worst_deg = std::max(
          {worst_deg, std::abs(across), std::abs(view.elevation / kDegree - one->elevation_deg)});
      ++directions;
    }
    if (common != usable || common != theirs->residuals.size()) return;
    const Dop expected = direct_dop(theirs->residuals);
    for (const auto& [ours, other] :
         {std::pair(sky.dop().gdop, expected.gdop), std::pair(sky.dop().pdop, expected.pdop),
          std::pair(sky.dop().hdop, expected.hdop), std::pair(sky.dop().vdop, expected.vdop)})
      worst_dop = std::max(worst_dop, std::abs(ours / other - 1.0));
    ++epochs;
  };
  read_inputs(log.path(), "LEONAV_", {compare, sky.ephemeris_store()}, nullptr);
  std::cout << "station against RTKLIB: " << directions << " directions, worst " << worst_deg
            << " deg; DOP of " << epochs << " epochs, worst " << 100.0 * worst_dop << " %\n";
  CHECK(directions > 4000);
  CHECK(epochs > 400);
  CHECK(worst_deg < 0.1);  // RTKLIB writes tenths
  CHECK(worst_dop < 0.01);
}

TEST_CASE("station: code multipath is that of a script which reads the RINEX file itself") {
  if (!have_shared_data(kObservations)) return;
  if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0) {
    std::cout << "SKIPPED: /usr/bin/python3 has no numpy (Debian package python3-numpy)\n";
    return;
  }
  const TemporaryFile log("station.lcmlog", "");
  import_station(log.path());
  const Quality quality = analyse_quality(log.path(), {}, nullptr);
  const std::string table = log.beside("oracle.txt");
  const std::string command = "'" LEONAV_SOURCE_DIR "/test/oracle/multipath.py' '" +
                              shared_data(kObservations) + "' >'" + table + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  std::istringstream lines(text_of(table));
  std::string satellite, code;
  double samples = 0.0, rms_m = 0.0, worst = 0.0;
  int same_arcs = 0, others = 0;
  while (lines >> satellite >> code >> samples >> rms_m) {
    // The navigator's partner of Galileo E1 is E5a; the script knows E5b alone.
    if (satellite[0] == 'E' && code == "1C") continue;
    CAPTURE(satellite, code, samples, rms_m);
    const auto& signals = quality.satellites.at(*satellite_from_string(satellite)).signals;
    const MultipathSum ours = signals.at(*signal_from_string(code)).multipath.all();
    if (static_cast<double>(ours.samples) == samples) {
      ++same_arcs;
      worst = std::max(worst, std::abs(ours.rms_m() / rms_m - 1.0));
      CHECK(ours.rms_m() == Approx(rms_m).epsilon(0.02));
    } else {
      ++others;  // an arc more or less at the horizon
      CHECK(ours.rms_m() == Approx(rms_m).epsilon(0.1));
    }
  }
  std::cout << "station multipath against the script: " << same_arcs
            << " satellites and signals with the same samples, worst " << 100.0 * worst << " %, "
            << others << " with others\n";
  CHECK(same_arcs > 90);
  CHECK(others < 20);
}
