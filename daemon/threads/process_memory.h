// These functions keep the memory of the process small and in place.
#pragma once
#include <string>

namespace leonav {

// To be called before any thread is started. From here on a large block that is freed goes back to
// the system, and a thread that a library starts has a stack of RealtimeThread::kStackBytes.
void prepare_memory();

// Locks all memory of the process, now and in future, and touches it (mlockall, mlock). Of the
// libraries that Ceres alone uses (BLAS, LAPACK, ...: 50 MB) the code is left unlocked, and is not
// brought in, unless `uses_ceres`.
// Returns what the system refused, as a text; empty: nothing.
std::string lock_memory(bool uses_ceres);

}  // namespace leonav
