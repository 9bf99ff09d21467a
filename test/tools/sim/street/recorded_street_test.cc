// Street errors from a library of residuals: what is drawn is what was recorded, and a file that is
// none is refused.
#include "tools/sim/street/recorded_street.h"
#include "core/base/angle.h"

#include <cmath>
#include <map>

#include "support/catch.h"
#include "support/sky/simulated_receiver.h"
#include "support/temporary_file.h"

using namespace leonav;
using namespace leonav::test;
using sim::RecordedStreet;
using sim::StreetEffect;

namespace {

const std::string kHeader = std::string(sim::kResidualLibraryHeader) + "\n";

// A piece of `rows` rows a second apart: the code's error of row i is first + i metres, its Doppler
// a hundredth of that, its carrier's 1 cm.
std::string piece(const std::string& name, double elevation_deg, double first, int rows) {
  std::string text;
  for (int i = 0; i < rows; ++i) {
    const std::string code = std::to_string(first + i);
    text += name + "," + std::to_string(i) + "," + std::to_string(elevation_deg) + ",2.5," + code +
            ",," + std::to_string(0.01 * (first + i)) + ",2,0.01\n";
  }
  return text;
}

sim::StreetErrorsConfig config_of(const std::string& rows,
                                  const std::vector<std::string>& recordings = {}) {
  const TemporaryFile file("library.csv", kHeader + rows);
  sim::StreetErrorsConfig config;
  config.family = sim::StreetFamily::kRecorded;
  config.library = std::make_shared<const sim::ResidualLibrary>(file.path(), recordings);
  return config;
}

void require_refused(const std::string& rows, const std::string& why) {
  const TemporaryFile file("library.csv", kHeader + rows);
  INFO(rows);
  REQUIRE_THROWS_WITH(sim::ResidualLibrary(file.path()), Catch::Contains(why));
}

const std::string kGood = "drive,G05,1,0.0,20,1,2,3,0.1,2,0.01\n";

}  // namespace

TEST_CASE("A block is a piece of the recording, row by row", "[sim][street]") {
  RecordedStreet street(config_of(piece("drive,G05,1", 20.0, 1000.0, 200)), 1, 3);
  double last = -1.0;
  int blocks = 0, length = 0, longest = 0;
  for (int t = 1; t <= 5000; ++t) {
    const StreetEffect now = street.at({static_cast<double>(t), 0.3, 1e-4});
    const double code = now.signals[0].code_m;
    CHECK((code >= 1000.0 && code < 1200.0));
    CHECK(now.loss_db == 2.5);
    CHECK(now.possible);
    CHECK(now.signals[0].doppler_m_s == Approx(0.01 * code));
    CHECK((now.signals[0].code_noise == 0.0 && now.signals[0].doppler_noise == 0.0));
    // The second signal, which the recording lacks, has the first one's error and its own noise.
    CHECK((now.signals[1].code_m == code && now.signals[1].code_noise == 1.0));
    length = code == last + 1.0 ? length + 1 : 1;
    blocks += length == 1 ? 1 : 0;
    longest = std::max(longest, length);
    last = code;
  }
  CHECK(longest <= 60);
  CHECK(longest >= 55);
  // A block begins anywhere and ends with the piece: 51 rows in the mean.
  CHECK(blocks == Approx(5000.0 / 51.0).epsilon(0.15));
}

TEST_CASE("A satellite has the errors of its class of elevation, or of the nearest there is",
          "[sim][street]") {
  const auto config =
      config_of(piece("drive,G05,1", 20.0, 100.0, 50) + piece("drive,G06,2", 70.0, 500.0, 50));
  const auto code_at = [&](double elevation_deg) {
    RecordedStreet street(config, 1, 3);
    return street.at({1.0, elevation_deg * kDegree, 1e-4}).signals[0].code_m;
  };
  CHECK(code_at(5.0) < 200.0);
  CHECK(code_at(25.0) < 200.0);
  CHECK(code_at(55.0) >= 500.0);
  CHECK(code_at(65.0) >= 500.0);
  CHECK(code_at(89.9) >= 500.0);
}

TEST_CASE("A carrier is off, breaks, slips and is missing as in the recording", "[sim][street]") {
  // From wherever a block begins, each ten rows hold one break, one slip and one without a carrier.
  std::string rows;
  for (int i = 0; i < 1000; ++i) {
    const int carrier = i % 10 == 2 ? 1 : i % 10 == 5 ? 3 : i % 10 == 8 ? 0 : 2;
    rows += "drive,G05,1," + std::to_string(i) + ",20,0,1,1,," + std::to_string(carrier) + "," +
            (carrier == 2 ? "0.02" : "") + "\n";
  }
  RecordedStreet street(config_of(rows), 1, 3);
  int breaks = 0, slips = 0, gaps = 0, goes_on = 0;
  unsigned route = 0;
  for (int t = 1; t <= 10'000; ++t) {
    const StreetEffect now = street.at({static_cast<double>(t), 0.3, 1e-4});
    const bool any = now.slips[0].cycles != 0.0 || now.slips[1].cycles != 0.0;
    const bool told = now.slips[0].told || now.slips[1].told;
    breaks += told ? 1 : 0;
    slips += any && !told ? 1 : 0;
    gaps += now.route != route ? 1 : 0;
    route = now.route;
    const bool off = now.signals[0].carrier_m == 0.02;
    CHECK((off || now.signals[0].carrier_m == 0.0));
    CHECK((off == (now.signals[0].carrier_noise == 0.0)));
    CHECK(now.signals[0].carrier_m == now.signals[1].carrier_m);
    goes_on += off ? 1 : 0;
    CHECK((now.signals[0].doppler_m_s == 0.0 && now.signals[0].doppler_noise == 1.0));
  }
  CHECK(breaks == Approx(1000).epsilon(0.05));
  CHECK(slips == Approx(1000).epsilon(0.05));
  CHECK(gaps == Approx(1000).epsilon(0.05));
  CHECK(goes_on == Approx(7000).epsilon(0.05));
}

TEST_CASE("Where nothing was recorded nothing is received", "[sim][street]") {
  std::string rows;
  for (int i = 0; i < 1000; ++i) {
    const bool missing = i % 10 < 3;
    rows += "drive,G05,1," + std::to_string(i) + (missing ? ",20,,,,,0,\n" : ",20,0,1,1,0.1,2,0\n");
  }
  RecordedStreet street(config_of(rows), 1, 3);
  int missing = 0;
  for (int t = 1; t <= 10'000; ++t) {
    missing += street.at({static_cast<double>(t), 0.3, 1e-4}).possible ? 0 : 1;
  }
  CHECK(missing == Approx(3000).epsilon(0.05));
}

TEST_CASE("A recording's interval is kept, whatever the receiver's", "[sim][street]") {
  std::string rows;
  for (int i = 0; i < 4000; ++i) {
    rows += "walk,G05,1," + std::to_string(0.25 * i) + ",20,0," + std::to_string(i) + ",,,2,0\n";
  }
  const auto config = config_of(rows);
  for (const double step_s : {0.1, 0.25, 1.0}) {
    RecordedStreet street(config, 1, 3);
    int steady = 0, all = 0;
    double last = street.at({step_s, 0.3, 1e-4}).signals[0].code_m;
    for (int i = 2; i * step_s < 500.0; ++i, ++all) {
      const double code = street.at({i * step_s, 0.3, 1e-4}).signals[0].code_m;
      steady += std::abs(code - last - step_s / 0.25) < 1.0 ? 1 : 0;
      last = code;
    }
    INFO(step_s);
    CHECK(all - steady < 20);  // blocks that begin
  }
}

TEST_CASE("Of a library the named recordings alone are drawn from", "[sim][street]") {
  const std::string rows =
      piece("drive,G05,1", 20.0, 100.0, 50) + piece("walk,G05,1", 20.0, 500.0, 50);
  RecordedStreet street(config_of(rows, {"walk"}), 1, 3);
  for (int t = 1; t < 300; ++t) CHECK(street.at({1.0 * t, 0.3, 1e-4}).signals[0].code_m >= 500.0);
  CHECK_THROWS_WITH(config_of(rows, {"rover"}),
                    Catch::Contains("has no recording 'rover'") && Catch::Contains("drive, walk"));
}

TEST_CASE("A library that is none is refused with its line", "[sim][street]") {
  const TemporaryFile other("library.csv", "a,b\n1,2\n");
  CHECK_THROWS_WITH(sim::ResidualLibrary(other.path()),
                    Catch::Contains("library.csv:1") && Catch::Contains("recording"));
  CHECK_THROWS_WITH(sim::ResidualLibrary("/nonexistent.csv"), Catch::Contains("/nonexistent.csv"));
  require_refused("", "no usable row");
  require_refused("drive,G05,1,0.0,20,1,x,3,0.1,2,0.01\n", "library.csv:2");
  require_refused(kGood + "drive,G05,1,1.0,20,1,2,3,0.1\n", "library.csv:3");
  require_refused(kGood + "drive,G05,1,1.0,20,1,2,3,0.1,7,0.01\n", "carrier is beyond 0 to 3");
  require_refused(kGood + "drive,G05,1,1.0,20,1,2,3,0.1,1.5,\n", "carrier is none of 0, 1, 2, 3");
  require_refused(kGood + "drive,G05,1,1.0,120,1,2,3,0.1,2,\n", "elevation_deg is beyond");
  require_refused(kGood + "drive,G05,1,1.0,20,1,2e6,3,0.1,2,\n", "code_1_m is beyond");
  require_refused(kGood + "drive,G05,1,1.0,20,1,nan,3,0.1,2,\n", "library.csv:3");
  require_refused(kGood + "drive,G05,1,1.0,20,1,,3,0.1,2,\n", "code_2_m without code_1_m");
  require_refused(kGood + "drive,G05,1,-1.0,20,1,2,3,0.1,2,\n", "time_s is beyond");
  require_refused(kGood + "drive,G05,1,0.0,20,1,2,3,0.1,2,\n", "does not follow the row before");
  require_refused(kGood + "drive,G05,1,1.0,20,1,2,3,,2,\ndrive,G05,1,3.0,20,1,2,3,,2,\n",
                  "library.csv:4: time_s does not keep the interval");
  require_refused(kGood + "drive,G05,1,1.0,20,1,x,3,,2,\n", "tools/validate street-residuals");
}

TEST_CASE("A run with a library has its errors, and is not written over it", "[sim][street]") {
  const TemporaryFile file("library.csv", kHeader + piece("drive,G05,1", 20.0, 100.0, 100));
  const std::string yaml = "duration_s: 60\nroute: {standing_s: 60}\n";
  const SimulatedEpochs plain = simulate_epochs(yaml, {"receiver.multipath.code_m=0"}),
                        with = simulate_epochs(yaml, {"street_errors.family=recorded",
                                                      "street_errors.file=" + file.path()});
  int compared = 0;
  for (std::size_t k = 0; k < plain.epochs.size(); ++k) {
    const BySignal base = by_signal(plain.epochs[k]);
    for (const SignalObservation& o : with.epochs[k].observations) {
      const auto b = base.find({o.satellite, o.code});
      if (b == base.end()) continue;
      const double error = o.pseudorange_m - b->second.pseudorange_m;
      CHECK((error > 90.0 && error < 210.0));
      ++compared;
    }
  }
  CHECK(compared > 1000);
}
