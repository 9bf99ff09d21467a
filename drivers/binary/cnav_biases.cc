#include "drivers/binary/cnav_biases.h"

#include <initializer_list>

namespace leonav {
namespace {

using Delay = std::optional<double>;

// Returns a + factor * b where both are there.
Delay sum(const Delay& a, const Delay& b, double factor = 1.0) {
  if (!a || !b) return std::nullopt;
  return *a + factor * *b;
}

// Appends the delay of all signals of a band with these attributes.
class BiasWriter {
 public:
  BiasWriter(SatelliteId satellite, GpsTime received, std::vector<SignalBias>* biases)
      : satellite_(satellite), received_(received), biases_(biases) {}

  void add(char band, std::initializer_list<char> attributes, const Delay& delay_s) {
    if (!delay_s) return;
    for (const char attribute : attributes) {
      biases_->push_back({satellite_,
                          {band, attribute},
                          BiasKind::kBroadcastCode,
                          received_,
                          kSpeedOfLight * *delay_s,
                          {},
                          {}});
    }
  }

 private:
  SatelliteId satellite_;
  GpsTime received_;
  std::vector<SignalBias>* biases_;
};

}  // namespace

void append_biases(const GpsCnavDelays& delays, SatelliteId satellite, GpsTime received,
                   std::vector<SignalBias>* biases) {
  BiasWriter writer(satellite, received, biases);
  constexpr double kGamma = (77.0 / 60.0) * (77.0 / 60.0);
  const Delay& tgd = delays.tgd;
  writer.add('1', {'W', 'P'}, tgd);
  writer.add('2', {'W', 'P'}, tgd ? Delay(kGamma * *tgd) : std::nullopt);
  writer.add('1', {'C'}, sum(tgd, delays.isc_l1_ca, -1.0));
  writer.add('2', {'S', 'L', 'X'}, sum(tgd, delays.isc_l2c, -1.0));
  const Delay l5_i = sum(tgd, delays.isc_l5_i, -1.0), l5_q = sum(tgd, delays.isc_l5_q, -1.0);
  writer.add('5', {'I'}, l5_i);
  writer.add('5', {'Q'}, l5_q);
  if (l5_i && l5_q) writer.add('5', {'X'}, (*l5_i + *l5_q) / 2.0);
}

void append_biases(const BeidouCnavDelays& delays, SatelliteId satellite, GpsTime received,
                   std::vector<SignalBias>* biases) {
  BiasWriter writer(satellite, received, biases);
  writer.add('5', {'P'}, delays.b2a_pilot);
  writer.add('5', {'D'}, sum(delays.b2a_pilot, delays.b2a_data_minus_pilot));
  writer.add('5', {'X'}, sum(delays.b2a_pilot, delays.b2a_data_minus_pilot, 0.5));
  writer.add('1', {'P'}, delays.b1c_pilot);
  writer.add('1', {'D'}, sum(delays.b1c_pilot, delays.b1c_data_minus_pilot));
  writer.add('1', {'X'}, sum(delays.b1c_pilot, delays.b1c_data_minus_pilot, 0.25));
}

}  // namespace leonav
