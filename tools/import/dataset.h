// Dataset lists the files of a recording, as dataset.yaml names them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/base/gps_time.h"
#include "drivers/oem7/imu_scale.h"

namespace leonav {

// Paths are complete: those in the file are relative to its folder. Empty: not given.
struct Dataset {
  std::string path;  // path of the dataset.yaml
  std::string name;
  // Noon of the day of the recording, for files whose messages give the time of week alone (RTCM
  // 3); unset: not given. Their first message must be within three and a half days of it.
  GpsTime date;
  std::vector<std::string>
      observations;                     // in order of time; ObservationSource says of which formats
  std::vector<std::string> navigation;  // RINEX, .rtcm3 or .rtcm
  std::vector<std::string> leo_elements;  // broadcast elements of LEO satellites, in a table
  std::vector<std::string> orbits;        // SP3
  std::vector<std::string> clocks;        // RINEX clock
  std::vector<std::string> biases;        // Bias-SINEX, of the product of orbits and clocks
  // RTCM 3 with SSR (.rtcm3, .rtcm) or pages of HAS (.has, .ubx, .sbf) or PPP-B2b (.b2b, .sbf), in
  // order of time
  std::vector<std::string> corrections;
  double corrections_latency_s = 10.0;      // of RTCM, from a correction's time to its arrival
  bool corrections_at_antenna = true;       // CorrectionOptions::at_antenna
  std::vector<std::string> antenna_models;  // ANTEX
  std::string receiver_antenna;       // type and radome; empty: as in the observations' header
  std::vector<std::string> imu;       // imu.csv, .oem7, .gps, .sbf or .ubx
  std::optional<ImuScale> imu_scale;  // of a count, where an IMU of .oem7 has no documented one
  std::vector<std::string> truth;     // truth.csv

  std::vector<std::string> files() const;  // all files, including dataset.yaml
};

// Reads dataset.yaml.
//
// Each key holds a path or a list of paths; "" and [] stand for none. `date` is a day as
// 2024-03-20, `imu_scale` a list of two numbers, `corrections_latency_s` a number up to 600,
// `corrections_point` is `antenna` or `mass_centre`. Throws FileError with file and line for
// unreadable YAML, a second document in it, an unknown key (with the nearest known one) and a key
// given twice.
Dataset load_dataset(const std::string& path);

}  // namespace leonav
