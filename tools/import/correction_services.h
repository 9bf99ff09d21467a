// CorrectionServices makes states and biases of the messages of several correction services, and
// lets one service at a time correct the satellites of a system.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/gnss/propagation/signal_bias_store.h"
#include "drivers/ssr/correction_store.h"
#include "tools/import/service_choice.h"

namespace leonav {

// The service of a system has changed. A service's name is that of its stream with what it is, for
// example "'receiver' (Galileo HAS)".
struct ServiceChange {
  System system = System::kGps;
  GpsTime time;
  std::string from;  // empty: none was in use
  std::string to;
  bool is_return = false;  // `to` is preferred; otherwise `from` has paused
  double pause_s = 0.0;    // so long
};
// Returns a sentence without a full stop: who corrects the system now, and why.
std::string to_text(const ServiceChange& change);

// What a message makes.
struct CorrectionResult {
  std::vector<SignalBias> biases;  // before the states, whose clocks they belong to
  std::vector<CorrectedState> states;
  CorrectionSource source;        // of the states
  std::size_t usable_states = 0;  // also of a service that is not in use
  std::optional<ServiceChange> change;
  // Usable states were left out because another service is in use.
  bool is_left_out = false;
};

// It serves leonav-import and leonav-connect. Each service has a store of its own, so that services
// do not disturb each other's orbits, clocks and biases. All of them correct the same ephemerides.
// Biases are given with the states that they belong to: those of the service in use, all of them
// where the service has changed, and then ends of those of the service before that the new one does
// not give. Memory is bounded by the numbers of streams and satellites.
class CorrectionServices {
 public:
  explicit CorrectionServices(const CorrectionOptions& options,
                              const ServiceChoiceOptions& choice = {})
      : choice_options_(choice), ephemerides_(options) {}

  // Returns the number of a stream that brings corrections. Streams are preferred in the order of
  // these calls.
  std::size_t add_stream(const std::string& name);

  void add(const Ephemeris& ephemeris);
  // Keeps a message that came at `now`, GPS time, from a stream, and makes nothing of it.
  void add(std::size_t stream, const SsrMessage& message, GpsTime now);
  // Does the same, and returns what it makes.
  CorrectionResult take(std::size_t stream, const SsrMessage& message, GpsTime now);

  // What became of the messages of a stream, or of all.
  CorrectionCounters counters(std::size_t stream) const;
  CorrectionCounters counters() const;
  std::size_t services() const { return services_.size(); }
  std::uint64_t changes() const { return changes_; }
  std::uint64_t left_out_states() const { return left_out_states_; }
  // Names of the systems that a stream corrects at present, as "GPS, Galileo"; empty: none.
  std::string systems_of(std::size_t stream) const;

 private:
  using BiasKey = std::tuple<SatelliteId, SignalCode, BiasKind>;
  struct Service {
    CorrectionStore store;
    std::map<BiasKey, SignalBias> biases;  // the last ones
  };

  Service& service_of(const ServiceId& id);
  std::string name_of(const ServiceId& id) const;
  std::vector<SignalBias> keep(Service* service, const SsrMessage& message, GpsTime now);
  std::vector<SignalBias> biases_of_change(const ServiceChoice::Change& change, System system,
                                           GpsTime now);
  ServiceChange describe(const ServiceChoice::Change& change, System system, GpsTime now) const;

  ServiceChoiceOptions choice_options_;
  CorrectionStore ephemerides_;  // without corrections: with it a new service begins
  std::vector<std::string> streams_;
  std::map<ServiceId, Service> services_;
  std::map<System, ServiceChoice> choices_;
  std::uint64_t changes_ = 0, left_out_states_ = 0;
};

}  // namespace leonav
