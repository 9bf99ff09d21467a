#include "tools/connect/formats/stream_format.h"

#include <limits>

namespace leonav {

double StreamFormat::stamp_sigma_s() const { return std::numeric_limits<double>::quiet_NaN(); }

}  // namespace leonav
