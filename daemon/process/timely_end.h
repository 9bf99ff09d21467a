// This function ends a process that hangs while it stops.
#pragma once

namespace leonav {

// In `seconds` from now the process ends with EXIT_FAILURE and a line on standard error, unless it
// has ended by itself. For the end of main(): it takes SIGALRM for itself.
void end_within(unsigned seconds);

}  // namespace leonav
