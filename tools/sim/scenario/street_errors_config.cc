#include "tools/sim/scenario/street_errors_config.h"
#include "core/base/angle.h"

#include <vector>

namespace leonav::sim {
namespace {

void read_range(ConfigReader& group, const char* key, Bounds bounds, Range* range) {
  std::vector<double> ends = {range->least, range->most};
  group.numbers(key, bounds, &ends);
  if (ends.size() != 2 || ends[0] > ends[1])
    return group.report(key,
                        "must be two numbers, the least and the most that is drawn, as in [1, 5]");
  *range = {ends[0], ends[1]};
}

void read_multipath(ConfigReader& group, StreetMultipathConfig* multipath) {
  constexpr Bounds kStreetSigma = {0.0, 1e3};
  read_range(group, "code_low_m", kStreetSigma, &multipath->code_low_m);
  read_range(group, "code_high_m", kStreetSigma, &multipath->code_high_m);
  read_range(group, "carrier_low_m", kStreetSigma, &multipath->carrier_low_m);
  read_range(group, "carrier_high_m", kStreetSigma, &multipath->carrier_high_m);
  read_range(group, "time_s", {0.1, 1e5}, &multipath->time_s);
  group.number("episode_s", {1.0, 1e6}, &multipath->episode_s);
  group.number("correlation", {0.0, 1.0}, &multipath->correlation);
}

constexpr Bounds kStreetShare = {0.0, 1.0}, kMostOfTheTime = {0.0, 0.95}, kDuration_s = {0.1, 1e5};

void read_reflected(ConfigReader& group, StreetReflectedConfig* reflected) {
  group.number("share", kMostOfTheTime, &reflected->share);
  group.number("duration_s", kDuration_s, &reflected->duration_s);
  read_range(group, "path_m", {0.1, 1e4}, &reflected->path_m);
  group.number("drift_m_s", {0.0, 100.0}, &reflected->drift_m_s);
  read_range(group, "loss_db", {0.0, 60.0}, &reflected->loss_db);
}

void read_blocked(ConfigReader& group, StreetBlockedConfig* blocked) {
  group.number("share", kMostOfTheTime, &blocked->share);
  group.number("duration_s", kDuration_s, &blocked->duration_s);
}

void read_slips(ConfigReader& group, StreetSlipsConfig* slips) {
  group.number("interval_s", {0.1, 1e9}, &slips->interval_s);
  group.number("single_share", kStreetShare, &slips->single_share);
  group.number("pair_share", kStreetShare, &slips->pair_share);
  if (slips->single_share + slips->pair_share > 1.0)
    group.report("pair_share", "and single_share must not add up to more than 1");
  group.number("told_share", kStreetShare, &slips->told_share);
  group.integer("max_cycles", 1, 1'000'000, &slips->max_cycles);
}

// The file is read only by the family that needs it: a scenario may name one and be run with
// another family.
void read_library(ConfigReader& group, const std::filesystem::path& folder,
                  StreetErrorsConfig* street) {
  group.text("file", &street->file);
  group.list("recordings", &street->recordings);
  if (street->family != StreetFamily::kRecorded) return;
  if (street->file.empty()) {
    return group.report(
        "file", "must name a library of residuals; tools/validate street-residuals makes one");
  }
  street->file = (folder / street->file).lexically_normal().string();
  if (!std::filesystem::exists(street->file)) {
    return group.report("file",
                        street->file + " is not there; tools/validate street-residuals makes it");
  }
  try {
    street->library = std::make_shared<const ResidualLibrary>(street->file, street->recordings);
  } catch (const FileError& error) {
    group.report("file", error.what());
  }
}

}  // namespace

void read_street_errors(ConfigReader& group, const std::filesystem::path& folder,
                        StreetErrorsConfig* street) {
  group.choice<StreetFamily>("family",
                             {{"rays", StreetFamily::kRays},
                              {"correlated", StreetFamily::kCorrelated},
                              {"recorded", StreetFamily::kRecorded}},
                             &street->family);
  group.number("limit_elevation_deg", {0.0, 90.0}, &street->limit_elevation, kDegree);
  group.group("multipath", [&](ConfigReader& r) { read_multipath(r, &street->multipath); });
  group.group("reflected", [&](ConfigReader& r) { read_reflected(r, &street->reflected); });
  group.group("blocked", [&](ConfigReader& r) { read_blocked(r, &street->blocked); });
  group.group("slips", [&](ConfigReader& r) { read_slips(r, &street->slips); });
  group.number("block_s", {0.1, 1e5}, &street->block_s);
  read_library(group, folder, street);
}

void replace_by_family(const StreetErrorsConfig& street, ReceiverConfig* receiver) {
  if (street.family == StreetFamily::kRays) return;
  receiver->multipath.code_m = receiver->multipath.carrier_m = 0.0;
  receiver->tracking.slips_per_hour = 0.0;
}

void remove_errors(StreetErrorsConfig* street) {
  StreetMultipathConfig& multipath = street->multipath;
  multipath.code_low_m = multipath.code_high_m = {};
  multipath.carrier_low_m = multipath.carrier_high_m = {};
  street->reflected.share = 0.0;
  street->slips.interval_s = 1e9;
  if (street->family == StreetFamily::kRecorded) street->family = StreetFamily::kRays;
}

}  // namespace leonav::sim
