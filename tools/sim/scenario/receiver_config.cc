#include "tools/sim/scenario/receiver_config.h"

#include <numbers>

namespace leonav::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

void read_noise(ConfigReader& group, NoiseConfig* noise) {
  constexpr Bounds kSigma = {0.0, 1e3};
  group.number("code_m", kSigma, &noise->code_m);
  group.number("carrier_m", kSigma, &noise->carrier_m);
  group.number("doppler_m_s", kSigma, &noise->doppler_m_s);
}

}  // namespace

void read_receiver(ConfigReader& group, ReceiverConfig* receiver) {
  group.number("interval_s", {0.05, 900.0}, &receiver->interval_s);
  group.vector("lever_arm_b_m", {-100.0, 100.0}, &receiver->lever_arm_b);
  group.number("elevation_mask_deg", {0.0, 90.0}, &receiver->elevation_mask, kDegree);
  group.number("clock_offset_us", {-1e3, 1e3}, &receiver->clock_offset_s, 1e-6);
  group.number("clock_drift_ppb", {-1e4, 1e4}, &receiver->clock_drift, 1e-9);
  group.number("clock_drift_walk_ppb_per_sqrt_s", {0.0, 1e3}, &receiver->clock_drift_walk, 1e-9);
  group.number("latency_s", {0.0, 10.0}, &receiver->gnss_latency_s);
  group.group("noise", [&](ConfigReader& noise) {
    for (const System system : kSystems) {
      noise.group(std::string(to_string(system)).c_str(),
                  [&](ConfigReader& r) { read_noise(r, &receiver->noise[index_of(system)]); });
    }
  });
}

}  // namespace leonav::sim
