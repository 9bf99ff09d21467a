// The FileSource plays a file as if it came from a wire.
#pragma once
#include <memory>
#include <string>

#include "drivers/transport/byte_source.h"
#include "drivers/transport/playback_clock.h"

namespace boost::asio {
class io_context;
}

namespace leonav {

// The clocks that all files of one run share: recorded arrivals, and GPS times of the data. Both
// begin with the first file that asks.
struct PlaybackClocks {
  PlaybackClocks(double playback_speed, const ArrivalClock* arrival_clock)
      : speed(playback_speed), arrivals(playback_speed), gps(playback_speed), host(arrival_clock) {}

  // The time of arrival that a stream without recorded ones has now: by the recorded time passed.
  std::int64_t arrival_ns() const;

  double speed;
  PlaybackClock arrivals, gps;
  const ArrivalClock* host;
  ArrivalClock::Steady::time_point begin = ArrivalClock::Steady::now();
};

// A recording (recording.h) is played by its times of arrival, which the sink gets as they were.
//
// Any other file is played by the times that the sink decodes from it: bytes go on when the next
// message is due, by the interval of the last two. So a stream's first message, and one after a
// gap, comes early by up to the gap. A file without such times is played without waiting. `io` and
// `clocks` must outlive the source. Throws FileError where the file cannot be opened.
std::unique_ptr<ByteSource> make_file_source(boost::asio::io_context* io, PlaybackClocks* clocks,
                                             const std::string& path);

}  // namespace leonav
