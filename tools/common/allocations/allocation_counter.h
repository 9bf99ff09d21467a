// This unit counts the heap allocations of the program that links it, by operator new and by
// malloc.
#pragma once
#include <cstddef>

namespace leonav {

// Counts those of all threads; stop_counting_allocations() returns the number since the start.
void start_counting_allocations();
std::size_t stop_counting_allocations();

// Allocations of the daemon's threads by role ("leonav-ins", "leonav-gnss", "leonav-journal"), each
// from its first instruction on, summed over all engines.
struct ThreadAllocations {
  std::size_t inertial = 0, gnss = 0, journal = 0;
};
ThreadAllocations thread_allocations();

}  // namespace leonav
