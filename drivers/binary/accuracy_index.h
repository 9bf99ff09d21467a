// This unit gives the accuracy that an index of a navigation message stands for.
#pragma once

namespace leonav {

// Returns the user range accuracy in metres of an index of GPS or BeiDou D1/D2: the nominal value X
// of IS-GPS-200N 20.3.3.3.1.3 (2.8 m for 1, ...). It is -1 for 15, "no prediction".
double nominal_accuracy_m(unsigned index);

// Returns the signal-in-space accuracy in metres of an index (OS-SIS-ICD table 89); -1: no
// prediction or spare.
double galileo_sisa_m(unsigned index);

}  // namespace leonav
