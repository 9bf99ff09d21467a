// wait_a_moment() is for loops in which a test waits for another thread.
#pragma once
#include <chrono>
#include <thread>

namespace leonav::test {

// Sleeps for some 70 us. A yield would give the processor to other programs for whole slices of
// time, at every turn of the loop.
inline void wait_a_moment() { std::this_thread::sleep_for(std::chrono::microseconds(20)); }

}  // namespace leonav::test
