#include "core/filter/update/colored_code_weighting.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {
namespace {

// A code that adds nothing to the earlier ones weighs next to nothing.
constexpr double kMostInflation = 1e6;

}  // namespace

int ColoredCodeWeighting::find(SatelliteId satellite, SignalCode code) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].satellite == satellite && entries_[i].code == code) return static_cast<int>(i);
  }
  return -1;
}

// A new one, or that of the code not seen for longest.
int ColoredCodeWeighting::allocate_entry(GpsTime time) {
  if (entries_.size() < entries_.capacity()) {
    entries_.push_back(Entry{});
    return static_cast<int>(entries_.size()) - 1;
  }
  const auto oldest =
      std::min_element(entries_.begin(), entries_.end(),
                       [](const Entry& a, const Entry& b) { return a.next_time < b.next_time; });
  if (!(oldest->next_time < time)) return -1;
  *oldest = Entry{};
  return static_cast<int>(oldest - entries_.begin());
}

double ColoredCodeWeighting::weigh(const Measurement& code, SatelliteId satellite,
                                   const CodeErrorModel& error_model, double noise_variance,
                                   GpsTime time, int* entry_index) {
  const double correlated = code.own_correlated_variance();
  const double plain = noise_variance + correlated;
  *entry_index = find(satellite, code.code);
  const bool known = *entry_index >= 0;
  if (!known) *entry_index = allocate_entry(time);
  if (*entry_index < 0) return plain;
  Entry& entry = entries_[static_cast<std::size_t>(*entry_index)];
  entry.next_issue = error_model.orbit_issue;
  if (!known || !entry.time.is_set()) {
    entry.satellite = satellite;
    entry.code = code.code;
    entry.next = {plain, -correlated, correlated};
    entry.next_time = time;
    return plain;
  }
  const double dt = seconds_between(time, entry.time);
  const double r = std::exp(-std::max(dt, 0.0) / error_model.correlation_time_s);
  JointCovariance prior = entry.now;
  prior.cc +=
      square(error_model.random_walk) * std::max(dt, 0.0) + square(error_model.disturbance_m);
  prior.cb *= r;
  prior.bb = r * r * prior.bb + (1.0 - r * r) * correlated;
  if (entry.issue != error_model.orbit_issue) prior = {prior.cc, 0.0, correlated};
  const double innovation = prior.cc + 2.0 * prior.cb + prior.bb + noise_variance;
  const double to_c = prior.cc + prior.cb, to_b = prior.bb + prior.cb;
  entry.next = {prior.cc - square(to_c) / innovation, prior.cb - to_c * to_b / innovation,
                prior.bb - square(to_b) / innovation};
  entry.next_time = time;
  // 1 / (1/P_n - 1/P_(n-1)), P_(n-1) - P_n = to_c^2 / innovation.
  const double weighed = prior.cc * entry.next.cc * innovation / square(to_c);
  const double most = kMostInflation * plain;
  return weighed > 0.0 && weighed < most ? weighed : most;
}

void ColoredCodeWeighting::accept(int entry_index) {
  if (entry_index < 0 || entry_index >= static_cast<int>(entries_.size())) return;
  Entry& entry = entries_[static_cast<std::size_t>(entry_index)];
  entry.now = entry.next;
  entry.time = entry.next_time;
  entry.issue = entry.next_issue;
}

}  // namespace leonav
