// This unit counts the heap allocations of the program that links it, by operator new and by
// malloc.
#pragma once
#include <cstddef>

namespace leonav {

// Counts those of all threads; stop_counting_allocations() returns the number since the start.
void start_counting_allocations();
std::size_t stop_counting_allocations();

// Allocations of the daemon's threads by name ("leonav-ins" and so on), each from its first
// instruction on, summed over all engines. io and main are the threads of a test that have these
// names.
struct ThreadAllocations {
  std::size_t inertial = 0, gnss = 0, smoother = 0, out = 0, journal = 0, file = 0, io = 0,
              main = 0;
};
ThreadAllocations thread_allocations();

}  // namespace leonav
