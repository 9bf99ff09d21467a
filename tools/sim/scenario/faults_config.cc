#include "tools/sim/scenario/faults_config.h"
#include "core/base/angle.h"

#include <string>

namespace leonav::sim {
namespace {

void read_whom(ConfigReader& group, Fault* fault) {
  std::vector<std::string> names;
  if (group.list("systems", &names)) {
    for (const std::string& name : names) {
      const auto system = system_from_string(name);
      if (system)
        fault->systems.push_back(*system);
      else
        group.report("systems", "'" + name + "' is none of gps, galileo, beidou, leo");
    }
  }
  names.clear();
  if (group.list("satellites", &names)) {
    for (const std::string& name : names) {
      const auto satellite = satellite_from_string(name);
      if (satellite)
        fault->satellites.push_back(*satellite);
      else
        group.report("satellites", "'" + name + "' is no satellite, as G05 or L12 is");
    }
  }
}

void read_sizes(ConfigReader& group, Fault* fault) {
  constexpr Bounds kMetres = {-1e6, 1e6};
  switch (fault->kind) {
    case FaultKind::kSatelliteClock:
      group.number("jump_m", kMetres, &fault->jump_m);
      group.number("drift_m_s", {-1e4, 1e4}, &fault->drift_m_s);
      break;
    case FaultKind::kBadOrbit:
      group.number("along_m", kMetres, &fault->along_m);
      group.number("cross_m", kMetres, &fault->cross_m);
      group.number("radial_m", kMetres, &fault->radial_m);
      break;
    case FaultKind::kSpoofing:
      group.number("pull_m_s", {-1e4, 1e4}, &fault->pull_m_s);
      group.number("pull_time_s", {0.1, 1e4}, &fault->pull_time_s);
      break;
    case FaultKind::kImuSaturation:
      group.number("gyro_limit_deg_s", {1e-3, 1e6}, &fault->gyro_limit, kDegree);
      group.number("accel_limit_m_s2", {1e-3, 1e6}, &fault->accel_limit);
      break;
    case FaultKind::kLate:
      group.number("delay_s", {0.0, 1e4}, &fault->delay_s);
      [[fallthrough]];
    case FaultKind::kDuplicate:
      group.choice<Stream>("stream",
                           {{"imu", Stream::kImu},
                            {"gnss", Stream::kGnss},
                            {"products", Stream::kProducts},
                            {"odometer", Stream::kOdometer}},
                           &fault->stream);
      break;
    case FaultKind::kOutage:
      if (!group.is_scalar("below_elevation_deg")) break;
      group.number("below_elevation_deg", {0.0, 90.0}, &fault->below_elevation, kDegree);
      break;
    case FaultKind::kImuGap:
    case FaultKind::kReceiverReset:
      break;
  }
}

}  // namespace

void read_fault(ConfigReader& group, std::vector<Fault>* faults) {
  Fault fault;
  // Without a kind it would be an outage of everything, by a mere omission.
  if (!group.is_scalar("kind")) group.fail("kind", "must be given, as one word");
  group.choice<FaultKind>("kind",
                          {{"outage", FaultKind::kOutage},
                           {"satellite_clock", FaultKind::kSatelliteClock},
                           {"bad_orbit", FaultKind::kBadOrbit},
                           {"spoofing", FaultKind::kSpoofing},
                           {"imu_gap", FaultKind::kImuGap},
                           {"imu_saturation", FaultKind::kImuSaturation},
                           {"late", FaultKind::kLate},
                           {"duplicate", FaultKind::kDuplicate},
                           {"receiver_reset", FaultKind::kReceiverReset}},
                          &fault.kind);
  group.number("from_s", {-1e6, 1e6}, &fault.from_s);  // nodes of products lie before the start
  group.number("to_s", {0.0, 1e6}, &fault.to_s);
  if (!(fault.to_s > fault.from_s)) group.report("to_s", "must be after from_s");
  const bool of_satellites =
      fault.kind == FaultKind::kOutage || fault.kind == FaultKind::kSatelliteClock ||
      fault.kind == FaultKind::kBadOrbit || fault.kind == FaultKind::kSpoofing;
  if (of_satellites) read_whom(group, &fault);
  read_sizes(group, &fault);
  fault.where = group.where("kind");
  faults->push_back(fault);
}

}  // namespace leonav::sim
