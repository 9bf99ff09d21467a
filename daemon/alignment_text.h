// What an alignment lacks, in words for its user.
#pragma once
#include <cstdint>
#include <string>

#include "core/ins/alignment.h"

namespace leonav {

// Empty for nothing.
std::string to_text(const AlignmentNeed& need, const AlignmentConfig& config);

// Both parts in one number, for a Gauge; seconds whole, rounded up.
std::int64_t packed(const AlignmentNeed& need);
AlignmentNeed unpacked(std::int64_t number);

}  // namespace leonav
