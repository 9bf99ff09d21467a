#include "tools/connect/stream_watch.h"

#include <algorithm>
#include <vector>

#include "tools/common/format.h"

namespace leonav {
namespace {

constexpr std::size_t kRecentLooks = 11;  // ten seconds between the first and the last
constexpr std::uint64_t kLeastDamaged = 3;
// So many of the last intervals between epochs count. A longer one is a pause.
constexpr std::size_t kRecentIntervals = 3;
constexpr double kLongestInterval_s = 60.0;

}  // namespace

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
    case StreamState::kDamaged:
      return "damaged";
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
  last_epoch_ns_.reset();
  last_sample_ns_.reset();
  intervals_s_.clear();
  recent_.clear();
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

std::string StreamWatch::damage(const FormatCounts& counts, double least_share) {
  const std::uint64_t damaged = counts.damaged - recent_.front().damaged,
                      all = damaged + counts.frames - recent_.front().frames;
  if (damaged < kLeastDamaged ||
      static_cast<double>(damaged) < least_share * static_cast<double>(all)) {
    return "";
  }
  return leonav::format(
      "%llu of the last %llu messages were damaged: is the cable good, is the baud rate right at "
      "both ends, and does nothing else write to this stream?",
      static_cast<unsigned long long>(damaged), static_cast<unsigned long long>(all));
}

std::string StreamWatch::no_epochs(std::int64_t now_ns) const {
  return leonav::format(
      "no epoch with signals for %.0f s, although other messages come: does the receiver still "
      "send its measurements, does the port's rate suffice for them, and is the antenna connected?",
      age_s(last_epoch_ns_, now_ns));
}

void StreamWatch::note_epoch(std::int64_t now_ns) {
  if (last_epoch_ns_) {
    intervals_s_.push_back(std::min(age_s(last_epoch_ns_, now_ns), kLongestInterval_s));
    if (intervals_s_.size() > kRecentIntervals) intervals_s_.pop_front();
  }
  last_epoch_ns_ = now_ns;
}

double StreamWatch::no_data_limit_s() const {
  if (intervals_s_.empty()) return limits_.no_data_s;
  // The median: one pause among them does not make a later stop be told late.
  std::vector<double> sorted(intervals_s_.begin(), intervals_s_.end());
  std::sort(sorted.begin(), sorted.end());
  return std::max(limits_.no_data_s, 3.0 * sorted[(sorted.size() - 1) / 2]);
}

void StreamWatch::look(std::int64_t now_ns, const StreamFormat& format) {
  const FormatCounts counts = format.counts();
  const bool new_bytes = bytes_ > bytes_seen_, new_frames = counts.frames > seen_.frames,
             new_messages = counts.messages > seen_.messages,
             new_epochs = counts.epochs > seen_.epochs,
             new_samples = counts.samples.value_or(0) > seen_.samples.value_or(0);
  bytes_seen_ = bytes_;
  seen_ = counts;
  recent_.push_back(counts);
  if (recent_.size() > kRecentLooks) recent_.pop_front();
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
  if (new_epochs) note_epoch(now_ns);
  if (counts.epochs + counts.empty_epochs > 0 && !last_epoch_ns_) last_epoch_ns_ = now_ns;
  if (new_samples || (counts.samples && new_frames && !last_sample_ns_)) last_sample_ns_ = now_ns;
  // Half the share ends it, so that the state does not change each second.
  const double least_share = (state_ == StreamState::kDamaged ? 0.5 : 1.0) * limits_.damaged_share;
  if (silence_s(now_ns) > limits_.silent_s) {
    unreadable_since_ns_.reset();
    no_data_since_ns_.reset();
    last_epoch_ns_.reset();
    last_sample_ns_.reset();
    set(StreamState::kSilent,
        leonav::format("open, but no byte for %.0f s: ", silence_s(now_ns)) + silence_remedy_);
  } else if (age_s(unreadable_since_ns_, now_ns) > limits_.unreadable_s) {
    const std::string text = damage(counts, limits_.damaged_share);
    set(StreamState::kUnreadable, format.why_no_frames() + (text.empty() ? "" : "; ") + text);
  } else if (age_s(no_data_since_ns_, now_ns) > no_data_limit_s()) {
    // Damage may be why only messages of other kinds are whole.
    const std::string text = damage(counts, 2.0 * limits_.damaged_share);
    set(StreamState::kNoData, text.empty() ? format.why_no_messages() : text);
  } else if (age_s(last_epoch_ns_, now_ns) > no_data_limit_s()) {
    // Inertial samples, ephemerides and corrections must not hide it.
    const std::string text = damage(counts, 2.0 * limits_.damaged_share);
    set(StreamState::kNoData, text.empty() ? no_epochs(now_ns) : text);
  } else if (age_s(last_sample_ns_, now_ns) > limits_.no_data_s) {
    // Nor must epochs hide that the samples are missing which the configuration asks for.
    set(StreamState::kNoData,
        leonav::format("no inertial sample for %.0f s: ", age_s(last_sample_ns_, now_ns)) +
            format.why_no_samples());
  } else if (const std::string text = damage(counts, least_share);
             counts.frames > recent_.front().frames && !text.empty()) {
    // Where nothing is whole, it will be unreadable in a few seconds, or starts.
    set(StreamState::kDamaged, text);
  } else if (new_messages) {
    set(StreamState::kGood, format.detail());
  }
}

}  // namespace leonav
