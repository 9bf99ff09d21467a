// A StreamFormat turns the bytes of one stream into messages.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/transport/byte_source.h"

namespace leonav {

// Counts since the start, for the stream's status.
struct FormatCounts {
  std::uint64_t frames = 0;    // messages or lines of the format that are whole
  std::uint64_t messages = 0;  // published; of corrections those with states
  // Of these the receiver's epochs, with signals and without. Other messages do not stand for them.
  std::uint64_t epochs = 0, empty_epochs = 0;
  // Of these the samples of a receiver's inertial sensor; unset: they are not asked for.
  std::optional<std::uint64_t> samples;
  std::uint64_t damaged = 0;  // refused by checksum, length or number of columns
  std::uint64_t refused = 0;  // whole, but with values or times that cannot be used
};

// Something that the log tells once, a sentence without a full stop.
struct FormatNews {
  bool is_warning = true;
  std::string text;
};

class StreamFormat {
 public:
  virtual ~StreamFormat() = default;
  // A connection has begun, whose sender may be another one than before.
  virtual void on_open() {}
  // Decodes and publishes. Any bytes may come; a damaged message loses nothing but itself.
  virtual void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) = 0;
  // No more bytes will come.
  virtual void finish() {}
  virtual FormatCounts counts() const = 0;
  // The time of the last message, by which a file without recorded arrivals is played.
  virtual std::optional<DataTime> data_time() const = 0;
  // What the format tells of itself while all is well; may be empty.
  virtual std::string detail() const = 0;
  // Why bytes came and no whole message, or whole messages and nothing to publish, with a remedy: a
  // sentence without a full stop.
  virtual std::string why_no_frames() const = 0;
  virtual std::string why_no_messages() const = 0;
  // What the format tells of a receiver's inertial sensor whose samples are missing, with a remedy.
  virtual std::string why_no_samples() const { return ""; }
  // What is to be logged since the last call.
  virtual std::vector<FormatNews> take_news() { return {}; }
  // 1 sigma of the stamps against GPS time, s; NaN where they are the device's own.
  virtual double stamp_sigma_s() const;
};

// Returns the parts that are not empty, with semicolons between them.
std::string joined(std::initializer_list<std::string> parts);
// Returns those that are not empty as news.
std::vector<FormatNews> warnings_of(std::initializer_list<std::string> texts);

}  // namespace leonav
