// A ByteSource delivers the bytes of one stream with their times of arrival to a ByteSink.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace leonav {

// When what the sink has decoded so far was measured. Sources that keep a recording's pace ask.
struct DataTime {
  bool is_gps = true;  // false: by a clock that starts anywhere
  std::int64_t nanoseconds = 0;
};

// All calls come from the thread that runs the source's io_context.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void on_open() = 0;
  // Nothing is wrong, but the other side has not come yet: a server without a client. `what` is a
  // sentence.
  virtual void on_waiting(const std::string& what) { static_cast<void>(what); }
  // `arrival_ns`: time of the ArrivalClock, or as a recording has it.
  virtual void on_bytes(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) = 0;
  // The source could not be opened or broke off; `why` is a sentence with cause and remedy. It is
  // tried again in `retry_s`.
  virtual void on_failure(const std::string& why, double retry_s) = 0;
  // The source is finished for good; `why` is empty at the regular end of a file or pipe.
  virtual void on_end(const std::string& why) = 0;
  virtual std::optional<DataTime> data_time() const { return std::nullopt; }
};

// Once started, a source delivers until its end or until it is destroyed.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  // `sink` must outlive this object.
  virtual void start(ByteSink* sink) = 0;
  // Drops a connection that may be dead without either side knowing, and makes it anew; the sink
  // gets `why`. A source that cannot be in this state ignores it.
  virtual void reconnect(const std::string& why) { static_cast<void>(why); }
};

}  // namespace leonav
