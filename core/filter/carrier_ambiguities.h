// These functions let the ambiguity states of a StateEstimate come and go with the carrier arcs.
#pragma once
#include "core/filter/arc_joiner.h"
#include "core/filter/estimate/state_estimate.h"
#include "core/filter/update/filter_measurement.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// Removes the ambiguities of arcs that have ended: the satellite has another arc now, to which it
// cannot be joined, its carrier was rejected in two epochs in a row, or it was not used for more
// than `max_gap_s`.
void remove_ended_arcs(const MeasurementEpoch& epoch, double max_gap_s, const ArcJoiner& joiner,
                       StateEstimate* estimate);

// Removes ambiguities without a carrier in this epoch, the longest unused first, until the new arcs
// fit into the state.
void make_room_for_new_arcs(const MeasurementEpoch& epoch, StateEstimate* estimate);

// Removes all ambiguities, or those of one system (an index of System).
void remove_all_ambiguities(StateEstimate* estimate);
void remove_ambiguities_of(std::size_t system, StateEstimate* estimate);

// Returns the state of the arc's ambiguity. A new arc's starts at `entry.innovation`, with a sigma
// so wide that this use of the prediction does not count. kNoAmbiguity: no capacity.
int find_or_add_ambiguity(const Measurement& carrier, SatelliteId satellite,
                          const FilterMeasurement& entry, GpsTime time, StateEstimate* estimate);

// Inflates arcs whose constant, and the position where its meaning, may have stepped since the last
// epoch (Measurement::disturbance_m, MeasurementEpoch::position_disturbance_m).
void inflate_disturbed_states(const MeasurementEpoch& epoch, StateEstimate* estimate);

// Records whether the update used a carrier. Returns true if it was rejected so often in a row that
// the arc counts as slipped, whatever the slip tests found.
bool record_carrier(const FilterMeasurement& carrier, GpsTime time, StateEstimate* estimate);

}  // namespace leonav
