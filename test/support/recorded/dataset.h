// A recorded data set in memory, and an ephemeris store that is fed as a live receiver would be.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/signals/observation.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "support/recorded/shared_data.h"

namespace leonav::test {

struct TruthPoint {
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
};

struct Dataset {
  std::vector<RawEpoch> epochs;
  std::vector<Ephemeris> ephemerides;  // by toe
  std::vector<PreciseState> states;    // by time
  KlobucharModel klobuchar;
  std::vector<TruthPoint> truth;  // by time
};

inline std::vector<TruthPoint> read_truth_points(const std::string& path) {
  std::vector<TruthPoint> points;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::array<double, 5> value{};
    char comma = 0;
    for (double& v : value) fields >> v >> comma;
    points.push_back({GpsTime::from_week_and_tow(static_cast<int>(value[0]), value[1]),
                      to_ecef({value[2] * kDegree, value[3] * kDegree, value[4]})});
  }
  return points;
}

// Paths relative to the shared data; empty ones are left out.
inline Dataset read_dataset(const std::string& observations,
                            const std::vector<std::string>& navigation,
                            const std::vector<std::string>& orbits, const std::string& truth) {
  Dataset data;
  ObservationReader reader(shared_data(observations));
  RawEpoch epoch;
  while (reader.next(&epoch)) data.epochs.push_back(epoch);
  for (const std::string& path : navigation) {
    const NavigationFile file = read_navigation(shared_data(path));
    data.ephemerides.insert(data.ephemerides.end(), file.ephemerides.begin(),
                            file.ephemerides.end());
    if (file.klobuchar.valid) data.klobuchar = file.klobuchar;
  }
  std::stable_sort(data.ephemerides.begin(), data.ephemerides.end(),
                   [](const Ephemeris& a, const Ephemeris& b) { return a.toe < b.toe; });
  for (const std::string& path : orbits) {
    for (const Sp3Epoch& nodes : read_sp3(shared_data(path)).epochs) {
      data.states.insert(data.states.end(), nodes.states.begin(), nodes.states.end());
    }
  }
  if (!truth.empty()) data.truth = read_truth_points(shared_data(truth));
  return data;
}

inline Dataset read_drive(bool with_orbits) {
  std::vector<std::string> orbits;
  if (with_orbits) orbits.push_back("drive/COD0MGXFIN_20211180000_05M_ORB.SP3");
  return read_dataset("drive/gnss.obs", {"drive/gps_day.nav"}, orbits, "drive/truth.csv");
}
inline Dataset read_walk() {
  return read_dataset("walk/gnss.obs", {"walk/gnss.nav"}, {}, "walk/truth.csv");
}
inline Dataset read_station(bool with_orbits) {
  std::vector<std::string> orbits;
  if (with_orbits) {
    orbits = {"station/GRG0MGXFIN_2020176_15M.sp3", "station/GRG0MGXFIN_2020177_15M.sp3"};
  }
  Dataset data = read_dataset("station/ESBC00DNK_2020177_6H_30S.obs",
                              {"station/ESBC00DNK_2020177.nav"}, orbits, "");
  return data;
}
// Antenna reference point of the station: the marker's coordinates (data/README.md) plus 0.216 m
// up.
inline Eigen::Vector3d station_antenna() {
  const Eigen::Vector3d marker(3582104.766, 532590.177, 5232755.098);
  Geodetic geodetic = to_geodetic(marker);
  geodetic.height += 0.216;
  return to_ecef(geodetic);
}

// Feeds an ephemeris store, which holds only a few issues and nodes per satellite, as time goes on.
class Feed {
 public:
  Feed(const Dataset& data, const EphemerisConfig& options)
      : data_(data), ephemeris_store_(options) {
    ephemeris_store_.set_klobuchar(data.klobuchar);
    for (const PreciseState& state : data.states) {
      if (state.time == data.states.front().time) continue;
      nodes_ahead_s_ = 0.5 * static_cast<double>(kMaxOrbitNodes) *
                       seconds_between(state.time, data.states.front().time);
      break;
    }
  }
  // Ephemerides whose toe is at most an hour ahead, and as many orbit nodes ahead as behind.
  const EphemerisStore& at(GpsTime time) {
    while (next_ephemeris_ < data_.ephemerides.size() &&
           seconds_between(data_.ephemerides[next_ephemeris_].toe, time) <= 3600.0) {
      ephemeris_store_.add(data_.ephemerides[next_ephemeris_++]);
    }
    while (next_state_ < data_.states.size() &&
           seconds_between(data_.states[next_state_].time, time) <= nodes_ahead_s_) {
      ephemeris_store_.add(data_.states[next_state_++]);
    }
    return ephemeris_store_;
  }

 private:
  const Dataset& data_;
  EphemerisStore ephemeris_store_;
  double nodes_ahead_s_ = 0.0;
  std::size_t next_ephemeris_ = 0, next_state_ = 0;
};

// Truth at `time`, linear between points at most 1.5 s apart.
inline std::optional<Eigen::Vector3d> truth_at(const Dataset& data, GpsTime time) {
  const auto after =
      std::lower_bound(data.truth.begin(), data.truth.end(), time,
                       [](const TruthPoint& point, GpsTime t) { return point.time < t; });
  if (after == data.truth.end()) return std::nullopt;
  if (after->time == time) return after->p_e;
  if (after == data.truth.begin()) return std::nullopt;
  const auto before = after - 1;
  const double span = seconds_between(after->time, before->time);
  if (span > 1.5) return std::nullopt;
  const double share = seconds_between(time, before->time) / span;
  return before->p_e + share * (after->p_e - before->p_e);
}

// Velocity from the truth points around `time`, central difference over about +-`half_s`.
inline std::optional<Eigen::Vector3d> truth_velocity_at(const Dataset& data, GpsTime time,
                                                        double half_s = 0.1) {
  const auto a = truth_at(data, time.plus_seconds(-half_s));
  const auto b = truth_at(data, time.plus_seconds(half_s));
  if (!a || !b) return std::nullopt;
  return (*b - *a) / (2.0 * half_s);
}

inline Eigen::Vector3d error_ned(const Eigen::Vector3d& p_e, const Eigen::Vector3d& truth_e) {
  return rotation_ecef_to_ned(to_geodetic(truth_e)) * (p_e - truth_e);
}

inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::lround(place))];
}

inline double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace leonav::test
