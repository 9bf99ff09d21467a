// The point solution against RTKLIB's, epoch by epoch and satellite by satellite: leonav's
// corrected ranges are compared with the residuals that RTKLIB writes, at RTKLIB's own position, so
// that nothing but the range models differs (orbit, clock, group delay, ionosphere, troposphere,
// rotation of the Earth in flight). Then the two positions, and both against the truth.
#include <cstdio>
#include <map>
#include <memory>

#include "core/gnss/measurement/range_model.h"
#include "core/gnss/positioning/point_solution.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "support/catch.h"
#include "support/recorded/dataset.h"
#include "support/recorded/rtklib_ephemerides.h"
#include "support/recorded/rtklib_single.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct Comparison {
  const char* name = "";
  std::string observations, navigation;
  RtklibOptions rtklib;
  std::map<System, std::string> bands;  // left in the observations
  bool phone = false;                   // weights by C/N0, as the preset phone
  bool remove_offset = false;           // the truth's datum is not that of the orbits
};

struct Differences {
  std::vector<double> models_m;  // per satellite, clock of the system taken out
  // With RTKLIB's troposphere put into ours, and gravity's delay and the tide, which its point
  // solution leaves out, out of ours.
  std::vector<double> same_troposphere_m;
  std::vector<double> positions_m;  // leonav - RTKLIB where both use the same satellites
  std::vector<Eigen::Vector3d> leonav_ned, rtklib_ned;  // errors against the truth
  std::size_t epochs = 0;
};

// Saastamoinen's formula as RTKLIB evaluates it (its manual 2.4.2, E.5.4): standard atmosphere,
// humidity 0.7 in the point solution, mapped by 1 / sin E where leonav uses 0.5 and Niell (1996).
// Deeper than 100 m below the ellipsoid, where some of its four-satellite solutions lie, it is
// zero.
double rtklib_troposphere_m(const Geodetic& antenna, double elevation) {
  if (antenna.height < -100.0) return 0.0;
  const double h = std::max(antenna.height, 0.0);
  const double pressure = 1013.25 * std::pow(1.0 - 2.2557e-5 * h, 5.2568);
  const double temperature = 15.0 - 6.5e-3 * h + 273.16;
  const double vapour =
      6.108 * 0.7 * std::exp((17.15 * temperature - 4684.0) / (temperature - 38.45));
  const double dry = 0.0022768 * pressure /
                     (1.0 - 0.00266 * std::cos(2.0 * antenna.latitude) - 0.00028 * h / 1000.0);
  const double wet = 0.002277 * (1255.0 / temperature + 0.05) * vapour;
  return (dry + wet) / std::sin(elevation);
}

RawEpoch only_bands(const RawEpoch& raw, const std::map<System, std::string>& bands) {
  RawEpoch kept;
  kept.time = raw.time;
  for (const SignalObservation& o : raw.observations) {
    const auto of_system = bands.find(o.satellite.system);
    if (of_system == bands.end()) continue;
    if (of_system->second.find(o.code.band) == std::string::npos) continue;
    kept.observations.push_back(o);
  }
  return kept;
}

GnssConfig config_of(const Comparison& comparison) {
  GnssConfig config = default_gnss_config();
  config.elevation_mask = comparison.rtklib.mask_deg * 0.017453292519943295;
  config.code_combination = comparison.rtklib.ionosphere == "dual-freq"
                                ? CodeCombination::kIonosphereFree
                                : CodeCombination::kSingleFrequency;
  if (comparison.phone) {
    config.weight_model = WeightModel::kCn0;
    config.cn0_reference_dbhz = 38.0;
    for (SystemConfig& system : config.systems) system.sigma.code_m = 4.0;
  }
  for (const System system : kSystems) {
    config.systems[index_of(system)].enabled = comparison.bands.count(system) > 0;
  }
  return config;
}

void subtract_median(std::map<System, std::vector<double>>* by_system, std::vector<double>* out) {
  for (auto& [system, values] : *by_system) {
    if (values.size() < 3) continue;
    const double middle = quantile(values, 0.5);
    for (const double v : values) out->push_back(std::abs(v - middle));
  }
}

// At odd hours GPS's reference times lie equally far before and behind: either may be taken.
bool is_between_reference_times(GpsTime time) {
  return std::abs(std::remainder(time.tow_s() - 3600.0, 7200.0)) < 0.5;
}

// leonav's residuals at RTKLIB's position less RTKLIB's.
void compare_models(const RawEpoch& raw, const EphemerisStore& ephemeris_store,
                    const GnssConfig& config, const RtklibEpoch& rtklib, MeasurementEpoch* epoch,
                    Differences* out) {
  preprocess(raw, ephemeris_store, config, rtklib.p_e, epoch);
  const Geodetic antenna = to_geodetic(rtklib.p_e);
  std::map<System, std::vector<double>> models, same_troposphere;
  for (const Measurement& code : epoch->measurements) {
    if (code.observable != Observable::kCode) continue;
    const SatelliteInView& view = epoch->satellites[code.satellite_index];
    const RtklibResidual* theirs = rtklib.find(view.satellite);
    if (theirs == nullptr) continue;
    const double ours = code.value - predict_range(view, rtklib.p_e).range_m;
    const double difference = ours - theirs->residual_m;
    models[view.satellite.system].push_back(difference);
    same_troposphere[view.satellite.system].push_back(
        difference + view.path_m + view.troposphere_m -
        rtklib_troposphere_m(antenna, view.elevation));
  }
  subtract_median(&models, &out->models_m);
  subtract_median(&same_troposphere, &out->same_troposphere_m);
}

bool same_satellites(const MeasurementEpoch& epoch, const RtklibEpoch& rtklib) {
  std::size_t used = 0;
  for (const SatelliteInView& view : epoch.satellites) {
    if (!is_used(view.reason)) continue;
    if (rtklib.find(view.satellite) == nullptr) return false;
    ++used;
  }
  return used == rtklib.residuals.size();
}

template <typename Truth>
Differences compare(const Comparison& comparison, const Dataset& data, Truth truth) {
  const std::vector<RtklibEpoch> rtklib =
      run_rtklib(comparison.rtklib, comparison.observations, comparison.navigation);
  REQUIRE(!rtklib.empty());
  const GnssConfig config = config_of(comparison);
  Feed feed(data, config.ephemeris_store);
  RtklibFeed rtklib_feed(data, config.ephemeris_store);
  const auto epoch = std::make_unique<MeasurementEpoch>();
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  Differences out;
  for (const RawEpoch& all : data.epochs) {
    const RawEpoch raw = only_bands(all, comparison.bands);
    const EphemerisStore& ephemeris_store = feed.at(raw.time);
    const std::optional<Eigen::Vector3d> reference = truth(raw.time);
    const RtklibEpoch* theirs = rtklib_epoch_at(rtklib, raw.time);
    if (theirs != nullptr) {
      ++out.epochs;
    }
    if (theirs != nullptr && !is_between_reference_times(raw.time)) {
      compare_models(raw, rtklib_feed.at(raw.time), config, *theirs, epoch.get(), &out);
      if (reference) out.rtklib_ned.push_back(error_ned(theirs->p_e, *reference));
    }
    const PointSolution point =
        solve_point(raw, ephemeris_store, config, RobustConfig{}, p_e, epoch.get());
    if (point.status != PointStatus::kOk) continue;
    p_e = point.p_e;
    if (reference) out.leonav_ned.push_back(error_ned(p_e, *reference));
    if (theirs != nullptr && same_satellites(*epoch, *theirs)) {
      out.positions_m.push_back((p_e - theirs->p_e).norm());
    }
  }
  return out;
}

struct ErrorSummary {
  double horizontal_rms = 0.0, vertical_rms = 0.0;
};

ErrorSummary summarize(std::vector<Eigen::Vector3d> errors, bool remove_offset) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& e : errors) mean += e / static_cast<double>(errors.size());
  std::vector<double> horizontal, vertical;
  for (const Eigen::Vector3d& e : errors) {
    const Eigen::Vector3d left = remove_offset ? Eigen::Vector3d(e - mean) : e;
    horizontal.push_back(left.head<2>().norm());
    vertical.push_back(left.z());
  }
  return {rms(horizontal), rms(vertical)};
}

double share_above(const std::vector<double>& values, double limit) {
  const auto above =
      std::count_if(values.begin(), values.end(), [&](double v) { return v > limit; });
  return static_cast<double>(above) / static_cast<double>(values.size());
}

void print(const Comparison& comparison, const Differences& d) {
  const ErrorSummary ours = summarize(d.leonav_ned, comparison.remove_offset);
  const ErrorSummary theirs = summarize(d.rtklib_ned, comparison.remove_offset);
  std::printf(
      "%-32s models |leonav - RTKLIB| 50 %% %.3f 95 %% %.3f max %.3f m; with RTKLIB's "
      "troposphere 50 %% %.4f 95 %% %.4f max %.4f m (%zu ranges, %.2f %% above 1 mm)\n",
      comparison.name, quantile(d.models_m, 0.5), quantile(d.models_m, 0.95),
      quantile(d.models_m, 1.0), quantile(d.same_troposphere_m, 0.5),
      quantile(d.same_troposphere_m, 0.95), quantile(d.same_troposphere_m, 1.0), d.models_m.size(),
      100.0 * share_above(d.same_troposphere_m, 1.0e-3));
  std::printf("%-32s positions, same satellites (%zu of %zu epochs): 50 %% %.2f 95 %% %.2f m\n", "",
              d.positions_m.size(), d.epochs, quantile(d.positions_m, 0.5),
              quantile(d.positions_m, 0.95));
  std::printf(
      "%-32s error RMS horizontal/vertical: RTKLIB %.2f/%.2f m (%zu epochs) | leonav %.2f/%.2f m "
      "(%zu)\n",
      "", theirs.horizontal_rms, theirs.vertical_rms, d.rtklib_ned.size(), ours.horizontal_rms,
      ours.vertical_rms, d.leonav_ned.size());
}

constexpr const char* kStationObservations = "station/ESBC00DNK_2020177_6H_30S.obs";
constexpr const char* kStationNavigation = "station/ESBC00DNK_2020177.nav";

}  // namespace

TEST_CASE("station: every corrected range agrees with RTKLIB's") {
  if (!have_shared_data(kStationNavigation) || !have_rtklib()) return;
  const Dataset data = read_station(false);
  const auto truth = [](GpsTime) { return std::optional<Eigen::Vector3d>(station_antenna()); };
  const std::vector<Comparison> comparisons = {
      {"station, GPS L1",
       kStationObservations,
       kStationNavigation,
       {1, "l1", "brdc", 15},
       {{System::kGps, "1"}}},
      {"station, GPS L1/L2",
       kStationObservations,
       kStationNavigation,
       {1, "l1+l2", "dual-freq", 15},
       {{System::kGps, "12"}}},
      {"station, Galileo E1",
       kStationObservations,
       kStationNavigation,
       {8, "l1", "brdc", 15},
       {{System::kGalileo, "1"}}},
      {"station, Galileo E1/E5b",
       kStationObservations,
       kStationNavigation,
       {8, "l1+l2", "dual-freq", 15},
       {{System::kGalileo, "17"}}},
      {"station, BeiDou B1I",
       kStationObservations,
       kStationNavigation,
       {32, "l1", "brdc", 15},
       {{System::kBeidou, "2"}}},
  };
  for (const Comparison& comparison : comparisons) {
    const Differences d = compare(comparison, data, truth);
    print(comparison, d);
    CHECK(d.epochs >= 720);
    CHECK(d.models_m.size() > 4000);
    CHECK(quantile(d.same_troposphere_m, 1.0) < 1.0e-3);
    const ErrorSummary ours = summarize(d.leonav_ned, false),
                       theirs = summarize(d.rtklib_ned, false);
    CHECK(d.leonav_ned.size() >= d.rtklib_ned.size());
    CHECK(ours.horizontal_rms < 1.15 * theirs.horizontal_rms);
  }
}

TEST_CASE("walk and drive: the point solution beside RTKLIB's") {
  if (!have_shared_data("walk/gnss.obs") || !have_shared_data("drive/gnss.obs") || !have_rtklib())
    return;
  const Dataset walk = read_walk();
  const auto walk_truth = [&](GpsTime time) { return truth_at(walk, time); };
  for (const Comparison& comparison : std::vector<Comparison>{
           {"walk, GPS L1",
            "walk/gnss.obs",
            "walk/gnss.nav",
            {1, "l1", "brdc", 15},
            {{System::kGps, "1"}},
            false,
            true},
           {"walk, GPS L1, Galileo E1",
            "walk/gnss.obs",
            "walk/gnss.nav",
            {41, "l1", "brdc", 15},
            {{System::kGps, "1"}, {System::kGalileo, "1"}},
            false,
            true},
       }) {
    const Differences d = compare(comparison, walk, walk_truth);
    print(comparison, d);
    CHECK(d.models_m.size() > 2000);
    CHECK(quantile(d.same_troposphere_m, 1.0) < 1.0e-3);
    CHECK(d.leonav_ned.size() >= d.rtklib_ned.size());
  }
  const Dataset drive = read_drive(false);
  const auto drive_truth = [&](GpsTime time) { return truth_at(drive, time); };
  const Comparison comparison{"drive, GPS L1",       "drive/gnss.obs",      "drive/gps_day.nav",
                              {1, "l1", "brdc", 15}, {{System::kGps, "1"}}, true};
  const Differences d = compare(comparison, drive, drive_truth);
  print(comparison, d);
  CHECK(d.models_m.size() > 9000);
  CHECK(quantile(d.same_troposphere_m, 1.0) < 1.0e-3);
  CHECK(d.leonav_ned.size() > d.rtklib_ned.size());
}
