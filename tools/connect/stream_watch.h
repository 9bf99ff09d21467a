// The StreamWatch decides in which state a stream is, and says so in a sentence.
#pragma once
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "tools/connect/formats/stream_format.h"

namespace leonav {

enum class StreamState : std::uint8_t {
  kConnecting,  // being opened, or open for too short a time to tell
  kWaiting,     // could not be opened or broke off; tried again later
  kSilent,      // open, but no byte comes
  kUnreadable,  // bytes come, but no whole message
  // Whole messages come, but nothing to publish, or a receiver's epochs have no signals, or samples
  // of its inertial sensor are asked for and missing.
  kNoData,
  kDamaged,  // messages are published, but many arrive damaged
  kGood,     // messages are published
  kEnded,    // finished for good
};

// Returns the word for the state in logs and in stream_t.
const char* name_of(StreamState state);

struct WatchLimits {
  double silent_s = 3.0;      // without a byte
  double unreadable_s = 5.0;  // with bytes, but without a whole message
  // With whole messages, but without one published, or without a receiver's epoch that has signals
  // (of one with rare epochs three times their interval, where that is longer), or without samples.
  double no_data_s = 10.0;
  double damaged_share = 0.1;  // of the messages of the last looks, and at least three of them
};

// Times are those of the ArrivalClock.
class StreamWatch {
 public:
  // `silence_remedy`: what to look at where no byte comes, a question.
  StreamWatch(const WatchLimits& limits, const std::string& silence_remedy)
      : limits_(limits), silence_remedy_(silence_remedy) {}

  void on_open(std::int64_t now_ns);
  void on_bytes(std::size_t count, std::int64_t now_ns);
  // The other side has not come yet, which is no failure.
  void on_waiting(const std::string& what) { set(StreamState::kConnecting, what); }
  // It is tried again `retry_s` later.
  void on_failure(const std::string& why, double retry_s, std::int64_t now_ns);
  void on_end(const std::string& why);

  // Looks at the stream; to be called about once a second.
  void look(std::int64_t now_ns, const StreamFormat& format);

  StreamState state() const { return state_; }
  // What is wrong and what to do, or what the format tells of itself.
  const std::string& text() const { return text_; }
  // How long an open connection has brought nothing, s; 0: it does, or is not open.
  double silence_s(std::int64_t now_ns) const;

  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t failures() const { return failures_; }
  // Since the last byte and the last message published, s; NaN: there was none.
  double byte_age_s(std::int64_t now_ns) const { return age_s(last_byte_ns_, now_ns); }
  double message_age_s(std::int64_t now_ns) const { return age_s(last_message_ns_, now_ns); }

 private:
  using Instant = std::optional<std::int64_t>;
  static double age_s(Instant since, std::int64_t now_ns) {
    return since ? static_cast<double>(now_ns - *since) * 1e-9
                 : std::numeric_limits<double>::quiet_NaN();
  }
  void tell_waiting(std::int64_t now_ns);
  // Returns how many of the last messages were damaged, with the remedy; empty: few.
  std::string damage(const FormatCounts& counts, double least_share);
  std::string no_epochs(std::int64_t now_ns) const;
  void note_epoch(std::int64_t now_ns);
  double no_data_limit_s() const;
  void set(StreamState state, const std::string& text) {
    state_ = state;
    text_ = text;
  }

  WatchLimits limits_;
  std::string silence_remedy_;
  StreamState state_ = StreamState::kConnecting;
  std::string text_;
  bool is_open_ = false;
  std::int64_t opened_ns_ = 0;
  std::string failure_;        // the latest
  std::int64_t retry_ns_ = 0;  // when it is tried again
  Instant last_byte_ns_, last_message_ns_;
  // Since when bytes come without a message, and messages without one published.
  Instant unreadable_since_ns_, no_data_since_ns_;
  // Of the last epoch with signals, or since when the next one is awaited; unset: the receiver has
  // sent no epoch at all.
  Instant last_epoch_ns_;
  Instant last_sample_ns_;          // the same of samples that are asked for
  std::deque<double> intervals_s_;  // between the last epochs
  std::uint64_t bytes_ = 0, bytes_seen_ = 0, failures_ = 0;
  FormatCounts seen_;                // at the last look
  std::deque<FormatCounts> recent_;  // of the last looks, the oldest first
};

}  // namespace leonav
