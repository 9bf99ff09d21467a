// ArcJoiner joins carrier arcs again that a gap or a slip has parted.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "core/filter/cycle_search.h"
#include "core/filter/error_model/learned_errors.h"
#include "core/filter/estimate/state_estimate.h"
#include "core/filter/update/filter_measurement.h"
#include "core/filter/whole_cycles.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// A new arc of a satellite's carrier differs from the one before by whole cycles. While the filter
// has the ambiguities of both, it knows their difference b_new - b_old within decimetres, and the
// geometry-free combination has changed over the gap by the ionosphere and cycles alone. Where only
// one pair of whole numbers fits both (search_cycles()), and the arcs of this receiver have been
// seen to differ by whole cycles (WholeCycles), the difference is known within the noise of the
// carriers, and the new arc goes on from the old one:
//
//   b_new - b_old = gamma1 lambda1 n1 + gamma2 lambda2 n2.
//
// This is the repair of cycle slips (Blewitt 1990, GRL 17, 199; Zhang and Li 2012, GPS Solutions
// 16, 207) with the filter's prediction as what is known of the range. Arcs of which a signal was
// weaker than the direct one are not joined: a reflection has another way. Nor are arcs of other
// signals, between which a receiver may leave a part of a cycle. The carriers that follow do not
// contradict a wrong join, because position and ambiguities move together: codes and the change of
// geometry do, slowly. Therefore the ambiguity keeps the probability of a wrong join, which the
// protection levels allow for.
class ArcJoiner {
 public:
  explicit ArcJoiner(const EkfConfig& config) : config_(config) {}

  // Forgets the arcs, but not what was learned of the receiver.
  void reset() { arcs_.clear(); }
  // Forgets that too.
  void forget() {
    arcs_.clear();
    whole_cycles_ = WholeCycles();
  }
  // Returns whether any two arcs have been compared, and the share of arcs that differ by whole
  // cycles (WholeCycles).
  bool has_compared() const { return whole_cycles_.pairs() > 0; }
  double whole_cycles_share() const { return whole_cycles_.share(); }
  // Returns whether an arc whose satellite has another one now may still be joined to that or to a
  // later one.
  bool keeps(std::uint32_t arc) const;
  // Joins what can be joined between two epochs; of arcs that are joined the earlier ambiguity is
  // removed. Returns the number of arcs joined.
  int join(StateEstimate* estimate);
  // Takes the carriers that an update has used, and forgets the arcs without an ambiguity.
  // `standing`: whether the vehicle stands.
  void observe(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
               const LearnedErrors& errors, bool standing, const FilterState& state);

 private:
  // The carrier of one arc, as it was last used.
  struct Arc {
    std::uint32_t arc = 0;
    SatelliteId satellite;
    GpsTime started, last;
    SignalCode code, second_code;
    CarrierCycles cycles;
    double first_geometry_free_m = 0.0;
    GeometryFreeTrend geometry_free;
    double sigma_m = 0.0;
    // Identities of what its constant depends on.
    OrbitSource source = OrbitSource::kNone;
    std::uint32_t orbit_issue = 0, antenna_issue = 0, ionosphere_issue = 0;
    bool direct = false;         // the signal was not weaker than it has been, at the last use
    bool always_direct = false;  // nor at any before
    // The share of whole cycles (WholeCycles) before it has learned from this arc.
    std::optional<double> share_before;
  };
  Arc* find(std::uint32_t arc);
  const Arc* find(std::uint32_t arc) const;
  void take(const Measurement& carrier, const SatelliteInView& satellite, GpsTime time,
            bool direct);
  // Returns the cycles between two arcs; nullopt: the arcs cannot be compared.
  std::optional<CycleSearch> cycles_between(const Arc& old, const Arc& now,
                                            const StateEstimate& estimate) const;
  bool join_one(StateEstimate* estimate);

  EkfConfig config_;
  WholeCycles whole_cycles_;
  boost::container::static_vector<Arc, kMaxArcs> arcs_;
};

}  // namespace leonav
