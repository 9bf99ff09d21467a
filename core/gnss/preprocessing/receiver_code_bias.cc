#include "core/gnss/preprocessing/receiver_code_bias.h"

#include <algorithm>
#include <cmath>

#include "core/base/median.h"

namespace leonav {
namespace {

// Temperature moves the difference of two front ends by centimetres per minute.
constexpr double kWalkVariance = 4.0e-4;  // m^2/s
constexpr double kMaxSpan = 3600.0;       // s; after a longer gap the growth stops mattering
// An epoch is an outlier if it deviates by more than five sigma and this margin. Several outliers
// in a row are a new delay (the receiver has restarted its tracking).
constexpr double kOutlierMargin = 10.0;  // m
constexpr int kMaxOutlierEpochs = 5;
constexpr double kMedianEfficiency = 1.5708;  // variance of a median against that of a mean

std::size_t digit(char band) { return static_cast<std::size_t>(band - '0'); }
bool is_digit(char band) { return band >= '0' && band <= '9'; }

}  // namespace

void ReceiverCodeBiases::open(GpsTime time) {
  if (time_.is_set() && time == time_) {
    systems_ = before_;
    return;
  }
  const double elapsed =
      time_.is_set() ? std::clamp(std::abs(seconds_between(time, time_)), 0.0, kMaxSpan) : 0.0;
  for (SystemBiases& system : systems_) {
    for (Bias& bias : system.bands) {
      if (bias.variance_m2 >= 0.0) bias.variance_m2 += kWalkVariance * elapsed;
    }
  }
  before_ = systems_;
  time_ = time;
}

void ReceiverCodeBiases::set_reference(System system, char band) {
  SystemBiases& biases = systems_[index_of(system)];
  if (biases.reference == band) return;
  biases = SystemBiases{};
  biases.reference = band;
}

void ReceiverCodeBiases::set_partner(System system, char band, double gamma) {
  systems_[index_of(system)].partner = band;
  systems_[index_of(system)].partner_gamma = gamma;
}

bool ReceiverCodeBiases::is_reference_pair(System system, char first, char second) const {
  const SystemBiases& biases = systems_[index_of(system)];
  return biases.partner != 0 && first == biases.reference && second == biases.partner;
}

void ReceiverCodeBiases::update(System system, char band, const InterBandDifferences& differences) {
  if (differences.values_m.empty() || !is_digit(band)) return;
  const double middle = median(differences.values_m);
  const double mapping =
      differences.ionosphere_mappings.empty() ? 0.0 : median(differences.ionosphere_mappings);
  auto deviations = differences.values_m;
  for (double& value : deviations) value = std::abs(value - middle);
  const double scaled_mad = std::max(1.4826 * median(deviations), differences.sigma_m);
  const double variance = kMedianEfficiency * scaled_mad * scaled_mad /
                          static_cast<double>(differences.values_m.size());

  Bias& bias = systems_[index_of(system)].bands[digit(band)];
  if (bias.variance_m2 < 0.0) {
    bias = {middle, variance, 0, mapping};
    return;
  }
  const double innovation = middle - bias.value_m;
  const double total = bias.variance_m2 + variance;
  if (std::abs(innovation) > 5.0 * std::sqrt(total) + kOutlierMargin) {
    if (++bias.outlier_epochs >= kMaxOutlierEpochs) bias = {middle, variance, 0, mapping};
    return;
  }
  const double gain = bias.variance_m2 / total;
  bias.value_m += gain * innovation;
  bias.ionosphere_mapping += gain * (mapping - bias.ionosphere_mapping);
  bias.variance_m2 *= 1.0 - gain;
  bias.outlier_epochs = 0;
}

const ReceiverCodeBiases::Bias* ReceiverCodeBiases::find(System system, char band) const {
  const SystemBiases& biases = systems_[index_of(system)];
  if (!is_digit(band) || band == biases.reference) return nullptr;
  const Bias& bias = biases.bands[digit(band)];
  return bias.variance_m2 >= 0.0 ? &bias : nullptr;
}

double ReceiverCodeBiases::delay_m(System system, char band) const {
  const Bias* bias = find(system, band);
  return bias != nullptr ? bias->value_m : 0.0;
}

// The clock of the reference pair is delayed by gamma times the delay of its partner.
double ReceiverCodeBiases::offset_m(System system, char band) const {
  const SystemBiases& biases = systems_[index_of(system)];
  return delay_m(system, band) - biases.partner_gamma * delay_m(system, biases.partner);
}

double ReceiverCodeBiases::ionosphere_mapping(System system, char band) const {
  const SystemBiases& biases = systems_[index_of(system)];
  const Bias* own = find(system, band);
  const Bias* partner = find(system, biases.partner);
  return (own != nullptr ? own->ionosphere_mapping : 0.0) -
         (partner != nullptr ? biases.partner_gamma * partner->ionosphere_mapping : 0.0);
}

void ReceiverCodeBiases::step_ionosphere_model(double step_m) {
  for (State* state : {&before_, &systems_}) {
    for (SystemBiases& system : *state) {
      for (Bias& bias : system.bands) bias.value_m -= step_m * bias.ionosphere_mapping;
    }
  }
}

void ReceiverCodeBiases::widen(System system, double variance_m2) {
  for (State* state : {&before_, &systems_}) {
    for (Bias& bias : (*state)[index_of(system)].bands) {
      if (bias.variance_m2 >= 0.0) bias.variance_m2 += variance_m2;
    }
  }
}

double ReceiverCodeBiases::variance_m2(System system, char band) const {
  const SystemBiases& biases = systems_[index_of(system)];
  const Bias* own = find(system, band);
  const Bias* partner = find(system, biases.partner);
  const double gamma = biases.partner_gamma;
  if (own == partner)
    return own != nullptr ? (1.0 - gamma) * (1.0 - gamma) * own->variance_m2 : 0.0;
  return (own != nullptr ? own->variance_m2 : 0.0) +
         (partner != nullptr ? gamma * gamma * partner->variance_m2 : 0.0);
}

}  // namespace leonav
