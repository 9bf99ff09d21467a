// A text states for the user what an alignment still needs.
#pragma once
#include <boost/static_string/static_string.hpp>
#include <cstdint>

#include "core/inertial/alignment/alignment.h"

namespace leonav {

// Made once a second while the daemon runs, which must not allocate.
using AlignmentText = boost::static_strings::static_string<160>;

// Empty: nothing is needed.
AlignmentText to_text(const AlignmentNeed& need, const AlignmentConfig& config);

// Packs both parts into one number for a Gauge; seconds are rounded up to whole ones.
std::int64_t pack_alignment_need(const AlignmentNeed& need);
AlignmentNeed unpack_alignment_need(std::int64_t number);

}  // namespace leonav
