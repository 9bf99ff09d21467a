// This function keeps OpenBLAS, which Ceres brings, from starting threads of its own.
#pragma once

namespace leonav {

// OpenBLAS starts its threads before main() and asks only the environment how many. Where that says
// nothing, the program is started once more, in the same process, with OPENBLAS_NUM_THREADS=1. Its
// threads are of no use here: in the service they hold 140 MB that are locked with the rest, take
// signals that are meant for main(), and hang at the end where memory is short; in the tools they
// wait for each other, and their sums differ in the last bits with the number of processors.
//
// To be called before the libraries begin, by an entry in the program's .preinit_array. (Valgrind
// follows with --trace-children=yes, or where the variable is set already.)
void start_with_one_blas_thread(int argc, char** argv, char** environment);

}  // namespace leonav
