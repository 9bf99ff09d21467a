// Where a vehicle was declared to stand, beside where it truly stood.
#pragma once
#include <iosfwd>
#include <vector>

#include "core/navigator/pipeline.h"
#include "tools/evaluation/track.h"

namespace leonav {

struct StopsConfig {
  double still_m_s = 0.06;  // m/s, three of the sigma the filter is told: slower is not false
  double creep_m_s = 0.3;   // from still_m_s up to here the vehicle creeps
  double shortest_s = 2.0;  // of a stop that ought to be found
};

// One instant at which the detector was asked.
struct AskedInstant {
  GpsTime time;
  bool standing = false;
};

struct TrueStop {
  GpsTime begin, end;
  double found_s = 0.0;         // of it
  double found_after_s = -1.0;  // -1: not
};

struct StopsResult {
  std::size_t asked = 0, standing = 0, creeping = 0;  // instants, with truth
  std::size_t without_truth = 0;                      // further ones, judged by nothing
  // Of `asked`: it moved, but slower than still_m_s. To declare that a stop is not called false.
  std::size_t slow = 0, slow_standing = 0;
  std::vector<std::pair<GpsTime, double>> wrong;  // when, and how fast it really went, m/s
  double fastest_m_s = 0.0;                       // at an instant declared to stand
  std::vector<TrueStop> stops;
  std::size_t stops_not_asked = 0;  // further ones, for all of which the detector was not asked
};

// Takes what the filter was told at its instants.
class StopsRecorder final : public OutputSink {
 public:
  const std::vector<AskedInstant>& asked() const { return asked_; }

 private:
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport& report) override;
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  std::vector<AskedInstant> asked_;
};

// Stretches of the truth slower than a centimetre a second for `shortest_s` or longer.
std::vector<TrueStop> stops_of(const Track& truth, const StopsConfig& config);

StopsResult judge_stops(const std::vector<AskedInstant>& asked, const Track& truth,
                        const StopsConfig& config);

void print_stops(const StopsResult& result, const StopsConfig& config, std::ostream& out);

}  // namespace leonav
