// This function tells how long the same reflection of a satellite's signal can last at most.
#pragma once

namespace leonav {

// Returns the time in which the direction of the satellite turns by two degrees, s: then another
// reflection is met, or none. `line_of_sight_rate`: rad/s. Infinite for a rate of zero. Some four
// seconds for a satellite in low orbit overhead, more than three minutes for one in medium orbit.
double longest_reflection_s(double line_of_sight_rate);

}  // namespace leonav
