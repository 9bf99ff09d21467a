#include "tools/connect/formats/outputs/file_biases.h"

#include <algorithm>
#include <tuple>

#include "tools/import/bias_files.h"

namespace leonav {
namespace {

auto validity(const SignalBias& bias) { return std::tuple(bias.valid_from, bias.valid_until); }

// An end replaces the bias of the same signal and beginning. One that would begin to hold later
// holds for no time that an epoch has.
SignalBias end_of(const SignalBias& bias, GpsTime now) {
  SignalBias end{bias.satellite, bias.code, bias.kind, now, 0.0, bias.valid_from, now};
  if (end.valid_from.is_set() && now <= end.valid_from) {
    end.valid_until = end.valid_from.plus_nanoseconds(1);
  }
  return end;
}

}  // namespace

FileBiases::FileBiases(std::vector<SignalBias> biases) {
  std::stable_sort(biases.begin(), biases.end(), [](const SignalBias& a, const SignalBias& b) {
    return validity(a) < validity(b);
  });
  for (const SignalBias& bias : biases) {
    const bool continues = !biases_.empty() && validity(bias) == validity(biases_.back().bias) &&
                           messages_.back().count < kOfMessage;
    if (continues) {
      ++messages_.back().count;
    } else {
      const GpsTime from = bias.valid_from;
      messages_.push_back({biases_.size(), 1,
                           from.is_set() ? from.plus_seconds(-kBiasLead_s) : from,
                           bias.valid_until});
    }
    biases_.push_back({bias});
  }
}

bool FileBiases::yields(SatelliteId satellite, GpsTime now) const {
  const auto found = of_service_.find(satellite);
  return found != of_service_.end() && now < found->second;
}

std::vector<SignalBias> FileBiases::take(std::size_t i, GpsTime now, bool missing_only) {
  std::vector<SignalBias> taken;
  const Message& message = messages_.at(i);
  for (std::size_t k = message.index; k < message.index + message.count; ++k) {
    One& one = biases_[k];
    if ((missing_only && one.is_published) || yields(one.bias.satellite, now)) continue;
    one.is_published = true;
    taken.push_back(one.bias);
    taken.back().time = now;
  }
  return taken;
}

bool FileBiases::is_whole(std::size_t i) const {
  const auto begin = biases_.begin() + static_cast<std::ptrdiff_t>(messages_.at(i).index);
  return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(messages_.at(i).count),
                     [](const One& one) { return one.is_published; });
}

// Where the service of a system changes, its new biases come with ends of those of the service
// before: a satellite's hold as long as one of its signals has one.
std::vector<SignalBias> FileBiases::yield_to(std::span<const SignalBias> of_service, GpsTime now) {
  std::map<SatelliteId, GpsTime> until;
  for (const SignalBias& bias : of_service) {
    if (bias.kind != BiasKind::kCode) continue;
    const GpsTime end =
        bias.valid_until.is_set() ? bias.valid_until : bias.time.plus_seconds(kLongestBiasAge_s);
    GpsTime& latest = until[bias.satellite];
    latest = std::max(latest, end);
  }
  for (const auto& [satellite, end] : until) of_service_[satellite] = end;
  std::vector<SignalBias> ends;
  for (One& one : biases_) {
    const SignalBias& bias = one.bias;
    if (!one.is_published || !until.contains(bias.satellite)) continue;
    if (!yields(bias.satellite, now)) continue;
    one.is_published = false;
    if (!bias.valid_until.is_set() || now < bias.valid_until) ends.push_back(end_of(bias, now));
  }
  return ends;
}

}  // namespace leonav
