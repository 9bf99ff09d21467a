// These functions tell the state of the streams, as the message STREAMS and as text.
#pragma once
#include <cstdint>
#include <leonav/streams_t.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/base/gps_time.h"
#include "tools/connect/stream.h"

namespace leonav {

// The channel of streams_t, without prefix. It is no input or output of leonavd.
inline constexpr const char* kStreamsChannel = "STREAMS";

// `time`: of the last measurement published. `now_ns`: of the ArrivalClock.
streams_t streams_message(const std::vector<std::unique_ptr<Stream>>& streams, GpsTime time,
                          std::uint64_t sequence, std::int64_t now_ns);

// One line: state, counts, and what the format tells of itself.
std::string status_text(const Stream& stream, std::int64_t now_ns);

}  // namespace leonav
