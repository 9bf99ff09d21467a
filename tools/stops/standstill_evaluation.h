// This unit compares the declared standstills of a vehicle with the true ones.
#pragma once
#include <iosfwd>
#include <vector>

#include "core/navigator/navigator.h"
#include "tools/evaluate/track.h"

namespace leonav {

// Limits of the evaluation.
struct StopsConfig {
  // m/s, three sigmas of the zero-velocity update: a slower motion is no false standstill
  double still_m_s = 0.06;
  double creep_m_s = 0.3;   // from still_m_s up to here the vehicle creeps
  double shortest_s = 2.0;  // of a stop that should be found
};

// One instant at which the detector decided.
struct DetectorInstant {
  GpsTime time;
  bool standing = false;
};

// One true stop.
struct TrueStop {
  GpsTime begin, end;
  double found_s = 0.0;         // s of the stop
  double found_after_s = -1.0;  // -1: not found
};

// Result of the evaluation.
struct StopsResult {
  std::size_t asked = 0, standing = 0, creeping = 0;  // instants, with truth
  std::size_t without_truth = 0;                      // further ones, not evaluated
  // Those of `asked` that moved slower than still_m_s. A declared stop is then not false.
  std::size_t slow = 0, slow_standing = 0;
  std::vector<std::pair<GpsTime, double>> wrong;  // when, and the true speed, m/s
  double fastest_m_s = 0.0;                       // at an instant declared to stand
  std::vector<TrueStop> stops;
  std::size_t stops_not_asked = 0;  // further ones, at which the detector never decided
};

// StopsRecorder records the detector's decisions from the filter's reports.
class StopsRecorder final : public OutputSink {
 public:
  const std::vector<DetectorInstant>& asked() const { return asked_; }

 private:
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport& report) override;
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  std::vector<DetectorInstant> asked_;
};

// Returns the stretches of the truth slower than a centimetre a second for `shortest_s` or longer.
std::vector<TrueStop> stops_of(const Track& truth, const StopsConfig& config);

// Evaluates the decisions against the truth.
StopsResult evaluate_stops(const std::vector<DetectorInstant>& asked, const Track& truth,
                           const StopsConfig& config);

// Prints the result for people.
void print_stops(const StopsResult& result, const StopsConfig& config, std::ostream& out);

}  // namespace leonav
