#include "tools/sim/scenario/receiver_config.h"
#include "core/base/angle.h"

namespace leonav::sim {
namespace {

constexpr Bounds kNoiseSigma = {0.0, 1e3}, kTrackingShare = {0.0, 1.0}, kSeconds = {0.0, 1e4};

void read_noise(ConfigReader& group, NoiseConfig* noise) {
  group.number("code_m", kNoiseSigma, &noise->code_m);
  group.number("carrier_m", kNoiseSigma, &noise->carrier_m);
  group.number("doppler_m_s", kNoiseSigma, &noise->doppler_m_s);
}

void read_clock(ConfigReader& group, ReceiverClockConfig* clock) {
  group.choice<Oscillator>(
      "oscillator",
      {{"ideal", Oscillator::kIdeal}, {"ocxo", Oscillator::kOcxo}, {"tcxo", Oscillator::kTcxo}},
      &clock->oscillator);
  group.number("offset_us", {-1e3, 1e3}, &clock->offset_s, 1e-6);
  group.number("drift_ppb", {-1e4, 1e4}, &clock->drift, 1e-9);
  group.choice<ClockJumps>("jumps",
                           {{"none", ClockJumps::kNone},
                            {"code_and_carrier", ClockJumps::kCodeAndCarrier},
                            {"code", ClockJumps::kCode}},
                           &clock->jumps);
  group.number("jump_limit_us", {500.0, 1e4}, &clock->jump_limit_s, 1e-6);
  group.number("time_base_sigma_m", {0.0, 1e4}, &clock->time_base_sigma_m);
  group.number("time_base_walk_m_per_sqrt_h", {0.0, 1e3}, &clock->time_base_walk_m_per_sqrt_s,
               1.0 / 60.0);
}

void read_cn0(ConfigReader& group, Cn0Config* cn0) {
  group.group("zenith_dbhz", [&](ConfigReader& zenith) {
    for (const System system : kSystems) {
      zenith.number(std::string(to_string(system)).c_str(), {0.0, 90.0},
                    &cn0->zenith_dbhz[index_of(system)]);
    }
  });
  group.number("second_signal_db", {-40.0, 10.0}, &cn0->second_signal_db);
  group.number("horizon_loss_db", {0.0, 40.0}, &cn0->horizon_loss_db);
  group.number("scatter_db", {0.0, 10.0}, &cn0->scatter_db);
}

void read_tracking(ConfigReader& group, TrackingConfig* tracking) {
  group.number("acquire_dbhz", {0.0, 90.0}, &tracking->acquire_dbhz);
  group.number("hold_dbhz", {0.0, 90.0}, &tracking->hold_dbhz);
  group.number("acquire_s", kSeconds, &tracking->acquire_s);
  group.number("carrier_s", kSeconds, &tracking->carrier_s);
  group.number("slips_per_hour", {0.0, 1e5}, &tracking->slips_per_hour);
  group.number("told_share", kTrackingShare, &tracking->flagged_share);
  group.integer("max_slip_cycles", 1, 1'000'000, &tracking->max_slip_cycles);
  group.number("half_cycle_share", kTrackingShare, &tracking->half_cycle_share);
  group.number("half_cycle_s", kSeconds, &tracking->half_cycle_s);
  if (tracking->hold_dbhz > tracking->acquire_dbhz)
    group.report("hold_dbhz", "must not be above acquire_dbhz");
}

void read_multipath(ConfigReader& group, MultipathConfig* multipath) {
  group.number("code_m", kNoiseSigma, &multipath->code_m);
  group.number("carrier_m", kNoiseSigma, &multipath->carrier_m);
  group.number("elevation_deg", {1.0, 1e4}, &multipath->elevation, kDegree);
  group.number("time_s", {0.1, 1e5}, &multipath->time_s);
  group.number("length_m", {0.05, 1e5}, &multipath->length_m);
}

}  // namespace

void read_receiver(ConfigReader& group, ReceiverConfig* receiver) {
  group.boolean("ideal", &receiver->ideal);
  group.number("interval_s", {0.05, 900.0}, &receiver->interval_s);
  group.vector("lever_arm_b_m", {-100.0, 100.0}, &receiver->lever_arm_b);
  group.number("elevation_mask_deg", {0.0, 90.0}, &receiver->elevation_mask, kDegree);
  group.number("latency_s", {0.0, 10.0}, &receiver->gnss_latency_s);
  group.group("noise", [&](ConfigReader& noise) {
    for (const System system : kSystems) {
      noise.group(std::string(to_string(system)).c_str(),
                  [&](ConfigReader& r) { read_noise(r, &receiver->noise[index_of(system)]); });
    }
  });
  group.group("clock", [&](ConfigReader& r) { read_clock(r, &receiver->clock); });
  group.group("cn0", [&](ConfigReader& r) { read_cn0(r, &receiver->cn0); });
  group.group("tracking", [&](ConfigReader& r) { read_tracking(r, &receiver->tracking); });
  group.group("multipath", [&](ConfigReader& r) { read_multipath(r, &receiver->multipath); });
}

void remove_errors(ReceiverConfig* receiver) {
  receiver->noise.fill({0.0, 0.0, 0.0});
  receiver->multipath.code_m = receiver->multipath.carrier_m = 0.0;
  receiver->tracking.slips_per_hour = receiver->tracking.half_cycle_share = 0.0;
  receiver->cn0.scatter_db = 0.0;
}

}  // namespace leonav::sim
