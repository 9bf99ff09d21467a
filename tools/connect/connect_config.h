// ConnectConfig is the configuration of leonav-connect.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "drivers/imu_line/line_layout.h"
#include "drivers/oem7/imu_scale.h"
#include "drivers/ssr/correction_store.h"
#include "tools/connect/formats/outputs/known_orbits.h"
#include "tools/connect/formats/outputs/product_output.h"
#include "tools/connect/formats/receivers/ubx_options.h"
#include "tools/connect/source_options.h"
#include "tools/connect/stamps/gps_clock.h"
#include "tools/connect/stamps/imu_stamper.h"
#include "tools/import/service_choice.h"

namespace leonav {

inline constexpr double kKeyMillisecond_s = 1e-3;  // s, for keys in milliseconds

enum class FormatKind : std::uint8_t {
  kUbx,
  kRtcm3,
  kOem7,
  kSbf,
  kVectornav,
  kXsens,
  kImuLine,
  kHas,
  kB2b
};

struct StreamConfig {
  std::string name;
  SourceOptions source;
  FormatKind format = FormatKind::kUbx;
  LineLayout line;           // of kImuLine
  bool is_inertial = false;  // of kUbx, kOem7, kSbf: the receiver's own sensor is published too
  std::optional<ImuScale> imu_scale;  // of kOem7: of a count; empty: as documented for its type
  ImuStampOptions stamps;             // of inertial sensors
  double repeat_s = 30.0;   // of a receiver: an ephemeris is sent again after so long; 0: never
  GpsTime day;              // of kRtcm3 from a file: noon of the day it was recorded
  bool is_service = false;  // of kRtcm3, kHas, kB2b: corrections, no receiver
  bool uses_pages = false;  // of kUbx, kSbf: the corrections that the receiver gets are used
  std::string record;       // file for every byte; empty: none
  std::uint64_t record_limit_bytes = 10'000'000'000;  // of that file; 0: none
  double silent_s = 3.0;                              // a stream without bytes for so long is told
};

// Pulses of an inertial sensor at an input of the receiver.
struct PulseConfig {
  std::string stream;  // name of the sensor's; empty: none are connected
  PulseInput input;
};

struct ConnectConfig {
  LcmConfig lcm;
  TimeReference reference = TimeReference::kGnss;
  double gnss_latency_s = 0.05;
  PulseConfig pulse;
  double playback_speed = 1.0;
  CorrectionOptions corrections;
  ServiceChoiceOptions services;
  std::shared_ptr<const FileProducts> products = std::make_shared<FileProducts>();
  ExpectedOrbits expected_orbits = expected_by_default();  // else a stream says what is missing
  double status_interval_s = 10.0;  // of the text for each stream; 0: only changes
  std::vector<StreamConfig> streams;
};

// Whether all arrivals are those of files, with which the host's present clock has nothing to do.
bool has_only_files(const ConnectConfig& config);

// How often what comes from files is sent: as the receiver's ephemerides are.
double product_repeat_s(const ConnectConfig& config);

const char* name_of(FormatKind format);

// Reads a configuration file with the overrides of a command line ("key=value"). Paths in it are
// relative to its folder. Files of products are read here. Throws ConfigError with file, line, key
// and remedy.
ConnectConfig load_connect_config(const std::string& path,
                                  const std::vector<std::string>& overrides);

}  // namespace leonav
