// RTKLIB's single-point solution (rnx2rtkp) of recorded RINEX files, with each satellite's
// residual.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"

namespace leonav::test {

struct RtklibOptions {
  int systems = 1;                  // navsys: 1 GPS, 8 Galileo, 32 BeiDou
  std::string frequency = "l1";     // or l1+l2, l1+l2+l5
  std::string ionosphere = "brdc";  // or dual-freq
  int mask_deg = 15;
};

struct RtklibResidual {
  SatelliteId satellite;
  double residual_m = 0.0;
  double azimuth_deg = 0.0, elevation_deg = 0.0;  // to 0.1
};

struct RtklibEpoch {
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  std::vector<RtklibResidual> residuals;  // of the satellites used

  const RtklibResidual* find(SatelliteId id) const {
    for (const RtklibResidual& r : residuals) {
      if (r.satellite == id) return &r;
    }
    return nullptr;
  }
};

inline bool have_rtklib() {
  if (std::system("command -v rnx2rtkp >/dev/null 2>&1") == 0) return true;
  std::cout << "SKIPPED: rnx2rtkp (Debian package rtklib) is not on this machine\n";
  return false;
}

// $POS and $SAT records of the status file that rnx2rtkp writes beside its solution.
inline std::vector<RtklibEpoch> read_rtklib_status(const std::string& path) {
  std::vector<RtklibEpoch> epochs;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::string kind, name;
    int week = 0, number = 0;
    double tow = 0.0;
    fields >> kind >> week >> tow;
    if (kind == "$POS") {
      Eigen::Vector3d p_e;
      fields >> number >> p_e.x() >> p_e.y() >> p_e.z();
      epochs.push_back({GpsTime::from_week_and_tow(week, tow), p_e, {}});
    } else if (kind == "$SAT" && !epochs.empty()) {
      RtklibResidual residual;
      fields >> name >> number >> residual.azimuth_deg >> residual.elevation_deg >>
          residual.residual_m;
      const auto id = satellite_from_string(name);
      if (!id) continue;
      residual.satellite = *id;
      epochs.back().residuals.push_back(residual);
    }
  }
  return epochs;
}

// Paths relative to the shared data. Empty if the program failed.
inline std::vector<RtklibEpoch> run_rtklib(const RtklibOptions& options,
                                           const std::string& observations,
                                           const std::string& navigation) {
  const TemporaryFile config(
      "rtklib.conf",
      "pos1-posmode=single\npos1-frequency=" + options.frequency + "\npos1-elmask=" +
          std::to_string(options.mask_deg) + "\npos1-ionoopt=" + options.ionosphere +
          "\npos1-tropopt=saas\npos1-sateph=brdc\npos1-navsys=" + std::to_string(options.systems) +
          "\nout-solformat=xyz\nout-timesys=gpst\nout-timeform=tow\n"
          "out-outstat=residual\n");
  const std::string solution = config.beside("rtklib.pos");
  const std::string command = "rnx2rtkp -k '" + config.path() + "' -o '" + solution + "' '" +
                              shared_data(observations) + "' '" + shared_data(navigation) +
                              "' >/dev/null 2>&1";
  if (std::system(command.c_str()) != 0) return {};
  return read_rtklib_status(solution + ".stat");
}

// The epoch of the receiver's time tag: RTKLIB writes the time corrected by the receiver's clock.
inline const RtklibEpoch* rtklib_epoch_at(const std::vector<RtklibEpoch>& epochs, GpsTime time) {
  const auto after =
      std::lower_bound(epochs.begin(), epochs.end(), time.plus_seconds(-0.05),
                       [](const RtklibEpoch& epoch, GpsTime t) { return epoch.time < t; });
  if (after == epochs.end() || seconds_between(after->time, time) > 0.05) return nullptr;
  return &*after;
}

}  // namespace leonav::test
