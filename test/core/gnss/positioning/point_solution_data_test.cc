// Point solutions of recorded epochs, each from nothing, against the truth.
#include <cstdio>
#include <memory>

#include "core/gnss/positioning/point_solution.h"
#include "support/catch.h"
#include "support/recorded/dataset.h"

namespace leonav::test {
namespace {

struct Errors {
  std::size_t epochs = 0;
  std::vector<double> horizontal_m;
};

template <typename TruthAt>
Errors solve_all(const char* name, const Dataset& data, const GnssConfig& config, TruthAt truth) {
  Feed feed(data, config.ephemeris_store);
  const auto measurements = std::make_unique<MeasurementEpoch>();
  ReceiverCodeBiases biases;
  Errors errors;
  for (const RawEpoch& raw : data.epochs) {
    const std::optional<Eigen::Vector3d> truth_e = truth(raw.time);
    if (!truth_e) continue;
    ++errors.epochs;
    const PointSolution point = solve_point(raw, feed.at(raw.time), config, RobustConfig{},
                                            Eigen::Vector3d::Zero(), measurements.get(), &biases);
    if (point.status == PointStatus::kOk)
      errors.horizontal_m.push_back(error_ned(point.p_e, *truth_e).head<2>().norm());
  }
  std::printf("%-52s %zu of %zu: rms %.2f, 50 %% %.2f, 95 %% %.2f m\n", name,
              errors.horizontal_m.size(), errors.epochs, rms(errors.horizontal_m),
              quantile(errors.horizontal_m, 0.5), quantile(errors.horizontal_m, 0.95));
  return errors;
}

}  // namespace

TEST_CASE("point solutions of a phone in a car", "[data]") {
  if (!have_shared_data("drive/gnss.obs")) return;
  const Dataset data = read_drive(true);
  GnssConfig config = default_gnss_config();
  config.code_combination = CodeCombination::kSingleFrequency;
  config.weight_model = WeightModel::kCn0;
  config.cn0_reference_dbhz = 38.0;
  config.elevation_mask = 0.1745;
  config.cn0_mask_dbhz = 20.0;
  for (SystemConfig& system : config.systems) system.sigma.code_m = 4.0;
  const auto truth = [&](GpsTime time) { return truth_at(data, time); };
  config.systems[index_of(System::kBeidou)].enabled = false;
  const Errors both = solve_all("drive, GPS+Galileo, SP3", data, config, truth);
  config.systems[index_of(System::kGalileo)].enabled = false;
  const Errors gps = solve_all("drive, GPS, SP3", data, config, truth);
  for (const Errors& errors : {both, gps}) CHECK(errors.horizontal_m.size() == errors.epochs);
  CHECK(rms(both.horizontal_m) < 5.0);
  // RTKLIB 2.4.3 with GPS alone, 10 degree mask: 12.8 m over 1413 of the epochs.
  CHECK(quantile(gps.horizontal_m, 1413.0 / 1985.0) < 12.8);
}

TEST_CASE("point solutions of a station", "[data]") {
  if (!have_shared_data("station/ESBC00DNK_2020177_6H_30S.obs")) return;
  for (const bool orbits : {false, true}) {
    const Dataset data = read_station(orbits);
    const auto truth = [](GpsTime) { return std::optional(station_antenna()); };
    const Errors errors = solve_all(orbits ? "station, SP3" : "station, broadcast", data,
                                    default_gnss_config(), truth);
    CHECK(errors.horizontal_m.size() == errors.epochs);
    CHECK(rms(errors.horizontal_m) < (orbits ? 1.0 : 1.5));
  }
}

}  // namespace leonav::test
