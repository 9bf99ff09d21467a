// Point solutions of the recorded data sets against their truth: epochs solved, horizontal error.
#include <cstdio>
#include <memory>

#include "core/gnss/positioning/point_solution.h"
#include "support/catch.h"
#include "support/recorded/dataset.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct Quality {
  int epochs = 0;
  std::vector<double> horizontal_m;
};

template <typename Truth>
Quality measure(const char* name, const Dataset& data, const GnssConfig& config, Truth truth) {
  Feed feed(data, config.ephemeris_store);
  ReceiverCodeBiases biases;
  const auto epoch = std::make_unique<MeasurementEpoch>();
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  Quality quality;
  for (const RawEpoch& raw : data.epochs) {
    const std::optional<Eigen::Vector3d> reference = truth(raw.time);
    if (!reference) continue;
    ++quality.epochs;
    const PointSolution point =
        solve_point(raw, feed.at(raw.time), config, RobustConfig{}, p_e, epoch.get(), &biases);
    if (point.status != PointStatus::kOk) continue;
    p_e = point.p_e;
    quality.horizontal_m.push_back(error_ned(point.p_e, *reference).head<2>().norm());
  }
  REQUIRE(!quality.horizontal_m.empty());
  std::printf("%-38s %4zu of %4d epochs, horizontal RMS %.2f m, 50 %% %.2f, 95 %% %.2f\n", name,
              quality.horizontal_m.size(), quality.epochs, rms(quality.horizontal_m),
              quantile(quality.horizontal_m, 0.5), quantile(quality.horizontal_m, 0.95));
  return quality;
}

GnssConfig phone(bool galileo) {
  GnssConfig config = default_gnss_config();
  config.elevation_mask = 0.1745329;
  config.code_combination = CodeCombination::kSingleFrequency;
  config.weight_model = WeightModel::kCn0;
  config.cn0_reference_dbhz = 38.0;
  for (SystemConfig& system : config.systems) {
    system.enabled = false;
    system.sigma.code_m = 4.0;
  }
  config.systems[index_of(System::kGps)].enabled = true;
  config.systems[index_of(System::kGalileo)].enabled = galileo;
  return config;
}

}  // namespace

TEST_CASE("phone on a car: every epoch, better than RTKLIB's 12.8 m by far") {
  if (!have_shared_data("drive/gnss.obs")) return;
  const Dataset data = read_drive(true);
  const auto truth = [&](GpsTime time) { return truth_at(data, time); };
  const Quality gps = measure("drive, GPS L1+L5", data, phone(false), truth);
  CHECK(gps.horizontal_m.size() >= 1980);
  CHECK(rms(gps.horizontal_m) < 12.8);
  const Quality both = measure("drive, GPS+Galileo L1+L5", data, phone(true), truth);
  CHECK(both.horizontal_m.size() == 1985);
  CHECK(rms(both.horizontal_m) < 6.0);
  CHECK(quantile(both.horizontal_m, 0.95) < 12.0);
}

TEST_CASE("geodetic station: metres from broadcast, decimetres with precise orbits") {
  if (!have_shared_data("station/ESBC00DNK_2020177.nav")) return;
  GnssConfig config = default_gnss_config();
  for (SystemConfig& system : config.systems) system.sigma.code_m = 0.5;
  const auto truth = [](GpsTime) { return std::optional<Eigen::Vector3d>(station_antenna()); };
  const Quality broadcast =
      measure("station, all systems, broadcast", read_station(false), config, truth);
  const Quality precise =
      measure("station, all systems, precise", read_station(true), config, truth);
  CHECK(broadcast.horizontal_m.size() == 721);
  CHECK(rms(broadcast.horizontal_m) < 2.0);
  CHECK(precise.horizontal_m.size() == 721);
  CHECK(rms(precise.horizontal_m) < 1.0);
}
