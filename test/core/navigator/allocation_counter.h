// Counts heap allocations of the whole test program, by operator new and by malloc alike.
#pragma once
#include <cstddef>

namespace leonav::test {

void start_counting_allocations();
std::size_t stop_counting_allocations();  // since the start

}  // namespace leonav::test
