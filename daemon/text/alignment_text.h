// A text states for the user what an alignment still needs.
#pragma once
#include <cstdint>
#include <string>

#include "core/inertial/alignment/alignment.h"

namespace leonav {

// Empty: nothing is needed.
std::string to_text(const AlignmentNeed& need, const AlignmentConfig& config);

// Packs both parts into one number for a Gauge; seconds are rounded up to whole ones.
std::int64_t pack_alignment_need(const AlignmentNeed& need);
AlignmentNeed unpack_alignment_need(std::int64_t number);

}  // namespace leonav
