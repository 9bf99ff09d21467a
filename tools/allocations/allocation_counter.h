// Counts heap allocations of the program that this is linked to, by operator new and by malloc
// alike.
#pragma once
#include <cstddef>

namespace leonav {

// Of all threads.
void start_counting_allocations();
std::size_t stop_counting_allocations();  // since the start

// Of the daemon's threads by role ("leonav-ins", "leonav-gnss"), each from its first instruction
// on, all engines together.
struct ThreadAllocations {
  std::size_t inertial = 0, gnss = 0;
};
ThreadAllocations thread_allocations();

}  // namespace leonav
