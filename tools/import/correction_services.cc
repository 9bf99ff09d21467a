#include "tools/import/correction_services.h"

#include "tools/common/format.h"
#include "tools/common/system_name.h"

namespace leonav {
namespace {

const char* service_name(SsrService service) {
  switch (service) {
    case SsrService::kRtcm:
      return "SSR of RTCM";
    case SsrService::kIgs:
      return "SSR of the IGS";
    case SsrService::kGalileoHas:
      return "Galileo HAS";
    case SsrService::kBeidouB2b:
      break;
  }
  return "PPP-B2b";
}

}  // namespace

std::string to_text(const ServiceChange& change) {
  std::string text =
      std::string("corrections of ") + name_of(change.system) + " are now those of " + change.to;
  if (change.from.empty()) return text;
  if (change.is_return) return text + ", which is preferred to " + change.from;
  return text + format(": %s has given none for %.0f s", change.from.c_str(), change.pause_s);
}

std::size_t CorrectionServices::add_stream(const std::string& name) {
  streams_.push_back(name);
  return streams_.size() - 1;
}

void CorrectionServices::add(const Ephemeris& ephemeris) {
  ephemerides_.add(ephemeris);
  for (auto& [id, service] : services_) service.store.add(ephemeris);
}

CorrectionServices::Service& CorrectionServices::service_of(const ServiceId& id) {
  const auto found = services_.find(id);
  if (found != services_.end()) return found->second;
  return services_.emplace(id, Service{ephemerides_, {}}).first->second;
}

std::string CorrectionServices::name_of(const ServiceId& id) const {
  return "'" + streams_.at(id.stream) + "' (" + service_name(id.service) + ")";
}

std::vector<SignalBias> CorrectionServices::keep(Service* service, const SsrMessage& message,
                                                 GpsTime now) {
  service->store.add(message);
  std::vector<SignalBias> biases = biases_of(message, now);
  for (const SignalBias& bias : biases) {
    service->biases[{bias.satellite, bias.code, bias.kind}] = bias;
  }
  return biases;
}

void CorrectionServices::add(std::size_t stream, const SsrMessage& message, GpsTime now) {
  keep(&service_of({stream, message.service}), message, now);
}

CorrectionResult CorrectionServices::take(std::size_t stream, const SsrMessage& message,
                                          GpsTime now) {
  const ServiceId id{stream, message.service};
  Service& service = service_of(id);
  CorrectionResult result;
  std::vector<SignalBias> biases = keep(&service, message, now);
  std::vector<CorrectedState> states;
  if (has_clocks(message)) states = service.store.states(message, now);
  result.usable_states = states.size();
  ServiceChoice& choice = choices_.try_emplace(message.system, choice_options_).first->second;
  if (!states.empty()) {
    if (const auto change = choice.note(id, now)) {
      changes_ += change->from.has_value();
      result.change = describe(*change, message.system, now);
      result.biases = biases_of_change(*change, message.system, now);
    }
  }
  if (choice.in_use() == id) {
    if (!result.change) result.biases = std::move(biases);
    result.states = std::move(states);
    result.source = source_of(message);
  } else {
    left_out_states_ += states.size();
    result.is_left_out = !states.empty();
  }
  return result;
}

// Biases hold against the clocks of one service alone. Those that the new service does not give end
// now.
std::vector<SignalBias> CorrectionServices::biases_of_change(const ServiceChoice::Change& change,
                                                             System system, GpsTime now) {
  const auto& given = service_of(change.to).biases;
  std::vector<SignalBias> biases;
  for (const auto& [key, bias] : given) {
    const bool holds = seconds_between(now, bias.time) <= kLongestBiasAge_s;
    if (bias.satellite.system != system || !holds) continue;
    biases.push_back(bias);
    biases.back().time = now;
  }
  if (!change.from) return biases;
  for (const auto& [key, bias] : service_of(*change.from).biases) {
    if (bias.satellite.system != system || given.contains(key)) continue;
    biases.push_back({bias.satellite, bias.code, bias.kind, now, 0.0, {}, now});
  }
  return biases;
}

ServiceChange CorrectionServices::describe(const ServiceChoice::Change& change, System system,
                                           GpsTime now) const {
  return {system,
          now,
          change.from ? name_of(*change.from) : "",
          name_of(change.to),
          change.from && change.to < *change.from && change.pause_s <= choice_options_.fallback_s,
          change.pause_s};
}

CorrectionCounters CorrectionServices::counters(std::size_t stream) const {
  CorrectionCounters sum;
  for (const auto& [id, service] : services_) {
    if (id.stream == stream) sum += service.store.counters();
  }
  return sum;
}

CorrectionCounters CorrectionServices::counters() const {
  CorrectionCounters sum;
  for (const auto& [id, service] : services_) sum += service.store.counters();
  return sum;
}

std::string CorrectionServices::systems_of(std::size_t stream) const {
  std::string names;
  for (const auto& [system, choice] : choices_) {
    if (!choice.in_use() || choice.in_use()->stream != stream) continue;
    names += (names.empty() ? "" : ", ") + std::string(leonav::name_of(system));
  }
  return names;
}

}  // namespace leonav
