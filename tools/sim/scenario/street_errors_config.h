// StreetErrorsConfig chooses the family of errors that streets cause, and holds their sizes.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/config_reader.h"
#include "tools/sim/scenario/receiver_config.h"
#include "tools/sim/scenario/residual_library.h"

namespace leonav::sim {

// Where the errors of streets come from.
enum class StreetFamily {
  kRays,        // rays against the houses of `places`
  kCorrelated,  // random processes in time, without any geometry of houses
  kRecorded,    // pieces of the residuals of recorded runs
};

// A value is drawn from least to most.
struct Range {
  double least = 0.0, most = 0.0;
};

// Reflections that arrive with the direct signal.
struct StreetMultipathConfig {
  // 1 sigma below and above the limit of elevation, drawn per satellite and episode.
  Range code_low_m = {1.0, 5.0}, code_high_m = {0.3, 1.0};
  Range carrier_low_m = {0.003, 0.01}, carrier_high_m = {0.001, 0.003};
  Range time_s = {10.0, 30.0};  // correlation time, drawn per satellite and episode
  double episode_s = 120.0;     // mean duration of an episode
  double correlation = 0.5;     // of the two signals of a satellite
};

// A signal that arrives by a reflection alone.
struct StreetReflectedConfig {
  double share = 0.05, duration_s = 8.0;  // of the time; mean of an episode
  Range path_m = {5.0, 50.0};             // extra path at its begin, drawn by its logarithm
  double drift_m_s = 0.3;                 // the path's rate is drawn between minus and plus this
  Range loss_db = {3.0, 10.0};
};

// A signal that does not arrive.
struct StreetBlockedConfig {
  double share = 0.15, duration_s = 6.0;
};

// Slips of a satellite's carriers.
struct StreetSlipsConfig {
  double interval_s = 300.0;     // mean
  double single_share = 0.3333;  // by one cycle on one signal
  double pair_share = 0.3333;    // by the same cycle on both; the rest is random
  double told_share = 0.5;
  int max_cycles = 10;  // of the random ones
};

// Settings of the family.
struct StreetErrorsConfig {
  StreetFamily family = StreetFamily::kRays;
  double limit_elevation = 0.7853981633974483;  // rad; reflected and blocked below it only
  StreetMultipathConfig multipath;
  StreetReflectedConfig reflected;
  StreetBlockedConfig blocked;
  StreetSlipsConfig slips;
  std::string file;                                // of the library
  std::vector<std::string> recordings;             // of those in it; none: all
  double block_s = 60.0;                           // at most, of one piece that is drawn from it
  std::shared_ptr<const ResidualLibrary> library;  // of the family recorded
};

// Reads the group, including street_errors.file, whose path is relative to `folder`.
void read_street_errors(ConfigReader& group, const std::filesystem::path& folder,
                        StreetErrorsConfig* street);

// Switches off those errors of the receiver that the family has of its own.
void replace_by_family(const StreetErrorsConfig& street, ReceiverConfig* receiver);

// Removes what no navigator can model, as `ideal` requires; blocked signals stay.
void remove_errors(StreetErrorsConfig* street);

}  // namespace leonav::sim
