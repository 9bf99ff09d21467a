// These functions tell what the turning line of sight to a satellite does to a reflection of its
// signal.
#pragma once

namespace leonav {

// Returns the time in which the direction of the satellite turns by two degrees, s: then another
// reflection is met, or none. `line_of_sight_rate`: rad/s. Infinite for a rate of zero. Some four
// seconds for a satellite in low orbit overhead, more than three minutes for one in medium orbit.
double longest_reflection_s(double line_of_sight_rate);

// Returns the random walk of the carrier of a signal that arrives by a reflection, m/sqrt(s).
//
// Such a signal is received as if the antenna stood behind the wall. Where that makes the way
// longer by L, the carrier drifts by up to L omega while the line of sight turns by omega, for as
// long as the vehicle stays in front of the wall: as a random walk that is L omega sqrt(T).
// `detour_m`: L, 1 sigma. `line_of_sight_rate`: omega, rad/s. `duration_s`: T, also for a satellite
// in low orbit, whose detour changes meanwhile but whose wall is the same. With 10 m and 10 s it is
// 0.3 m/sqrt(s) for a satellite in low orbit overhead, 5 mm/sqrt(s) for one in medium orbit.
double reflected_random_walk(double detour_m, double line_of_sight_rate, double duration_s);

}  // namespace leonav
