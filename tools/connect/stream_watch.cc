#include "tools/connect/stream_watch.h"

#include <algorithm>

#include "tools/common/format.h"

namespace leonav {

const char* name_of(StreamState state) {
  switch (state) {
    case StreamState::kConnecting:
      return "connecting";
    case StreamState::kWaiting:
      return "waiting";
    case StreamState::kSilent:
      return "silent";
    case StreamState::kUnreadable:
      return "unreadable";
    case StreamState::kNoData:
      return "no data";
    case StreamState::kGood:
      return "good";
    case StreamState::kEnded:
      break;
  }
  return "ended";
}

void StreamWatch::on_open(std::int64_t now_ns) {
  is_open_ = true;
  opened_ns_ = now_ns;
  unreadable_since_ns_.reset();
  no_data_since_ns_.reset();
  set(StreamState::kConnecting, "open");
}

void StreamWatch::on_bytes(std::size_t count, std::int64_t now_ns) {
  bytes_ += count;
  last_byte_ns_ = now_ns;
}

void StreamWatch::on_failure(const std::string& why, double retry_s, std::int64_t now_ns) {
  is_open_ = false;
  ++failures_;
  failure_ = why;
  retry_ns_ = now_ns + static_cast<std::int64_t>(retry_s * 1e9);
  tell_waiting(now_ns);
}

void StreamWatch::tell_waiting(std::int64_t now_ns) {
  const double left_s = static_cast<double>(retry_ns_ - now_ns) * 1e-9;
  set(StreamState::kWaiting,
      failure_ + (left_s < 1.0 ? "; being tried again"
                               : leonav::format("; tried again in %.0f s", left_s)));
}

void StreamWatch::on_end(const std::string& why) {
  is_open_ = false;
  failures_ += why.empty() ? 0 : 1;
  set(StreamState::kEnded, why.empty() ? "the end" : why);
}

double StreamWatch::silence_s(std::int64_t now_ns) const {
  if (!is_open_) return 0.0;
  const std::int64_t since = last_byte_ns_ ? std::max(*last_byte_ns_, opened_ns_) : opened_ns_;
  return static_cast<double>(now_ns - since) * 1e-9;
}

void StreamWatch::look(std::int64_t now_ns, const StreamFormat& format) {
  const FormatCounts counts = format.counts();
  const bool new_bytes = bytes_ > bytes_seen_, new_frames = counts.frames > seen_.frames,
             new_messages = counts.messages > seen_.messages;
  bytes_seen_ = bytes_;
  seen_ = counts;
  if (new_messages) last_message_ns_ = now_ns;
  if (state_ == StreamState::kWaiting) tell_waiting(now_ns);
  if (!is_open_) return;
  // Each kind of fault is timed from where the step before it works.
  if (new_frames || (!new_bytes && !unreadable_since_ns_)) {
    unreadable_since_ns_.reset();
  } else if (new_bytes && !unreadable_since_ns_) {
    unreadable_since_ns_ = now_ns;
  }
  if (new_messages) {
    no_data_since_ns_.reset();
  } else if (new_frames && !no_data_since_ns_) {
    no_data_since_ns_ = now_ns;
  }
  if (silence_s(now_ns) > limits_.silent_s) {
    unreadable_since_ns_.reset();
    no_data_since_ns_.reset();
    set(StreamState::kSilent,
        leonav::format("open, but no byte for %.0f s: ", silence_s(now_ns)) + silence_remedy_);
  } else if (age_s(unreadable_since_ns_, now_ns) > limits_.unreadable_s) {
    set(StreamState::kUnreadable, format.why_no_frames());
  } else if (age_s(no_data_since_ns_, now_ns) > limits_.no_data_s) {
    set(StreamState::kNoData, format.why_no_messages());
  } else if (new_messages) {
    set(StreamState::kGood, format.detail());
  }
}

}  // namespace leonav
