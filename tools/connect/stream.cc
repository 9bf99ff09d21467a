#include "tools/connect/stream.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "tools/common/format.h"

namespace leonav {
namespace {

// A stream that may pause for long has also long pauses between messages that are published.
WatchLimits limits_of(const StreamConfig& config) {
  WatchLimits limits;
  limits.silent_s = config.silent_s;
  limits.no_data_s = std::max(limits.no_data_s, 2.0 * config.silent_s);
  return limits;
}

}  // namespace

Stream::Stream(const StreamConfig& config, const ArrivalClock* clock,
               std::unique_ptr<ByteSource> source, std::unique_ptr<StreamFormat> format)
    : name_(config.name),
      source_text_(text_of(config.source)),
      clock_(clock),
      source_(std::move(source)),
      format_(std::move(format)),
      watch_(limits_of(config), silence_remedy(config.source)),
      reconnect_after_s_(std::max(kReconnectAfter_s, config.silent_s)) {
  if (config.record.empty()) return;
  recording_ = std::make_unique<RecordingWriter>(
      config.record, RecordingLimits{.file_bytes = config.record_limit_bytes});
  is_recording_ = true;
  spdlog::info("{}: every byte goes to {}", name_, recording_->path());
}

void Stream::start() { source_->start(this); }

void Stream::end_recording() {
  if (recording_) recording_->end();
}

void Stream::finish() {
  if (recording_ && !recording_->close() && is_recording_) tell_recording_error();
}

void Stream::on_open() {
  watch_.on_open(clock_->now_ns());
  format_->on_open();
  if (recording_) recording_->note_opening();
  told_failure_.clear();
  spdlog::info("{}: {} is open", name_, source_text_);
}

void Stream::on_bytes(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  if (is_recording_ && !recording_->write(arrival_ns, bytes)) tell_recording_error();
  watch_.on_bytes(bytes.size(), clock_->now_ns());
  format_->feed(bytes, arrival_ns);
}

void Stream::on_waiting(const std::string& what) {
  watch_.on_waiting(what);
  told_ = watch_.state();
  spdlog::info("{}: {}", name_, what);
}

// The same failure is told once, however often it is tried.
void Stream::on_failure(const std::string& why, double retry_s) {
  watch_.on_failure(why, retry_s, clock_->now_ns());
  told_ = watch_.state();
  if (why == std::exchange(told_failure_, why)) return;
  const bool waits_grow = retry_s >= RetryWait::kFirst_s && retry_s < RetryWait::kLongest_s;
  spdlog::warn("{}: {}; trying again in {} s{}", name_, why, retry_s,
               waits_grow ? leonav::format(", then ever more rarely, at least every %.0f s",
                                           RetryWait::kLongest_s)
                          : "");
}

void Stream::on_end(const std::string& why) {
  format_->finish();
  look();
  watch_.on_end(why);
  told_ = watch_.state();
  const FormatCounts counts = format_->counts();
  if (why.empty() && counts.messages == 0) {
    spdlog::warn("{}: {} has ended and nothing could be published: {}", name_, source_text_,
                 counts.frames == 0 ? format_->why_no_frames() : format_->why_no_messages());
  } else if (why.empty()) {
    spdlog::info("{}: {} has ended, after {} messages", name_, source_text_, counts.messages);
  } else {
    spdlog::error("{}: {}", name_, why);
  }
}

void Stream::look() {
  if (is_recording_) look_at_recording();
  if (has_ended()) return;
  const std::int64_t now_ns = clock_->now_ns();
  watch_.look(now_ns, *format_);
  const StreamState state = watch_.state();
  if (state != std::exchange(told_, state)) {
    const bool is_bad = state == StreamState::kSilent || state == StreamState::kUnreadable ||
                        state == StreamState::kNoData || state == StreamState::kDamaged;
    spdlog::log(is_bad ? spdlog::level::warn : spdlog::level::info, "{}: {}{}{}", name_,
                name_of(state), watch_.text().empty() ? "" : ": ", watch_.text());
  }
  tell_news();
  if (watch_.silence_s(now_ns) > reconnect_after_s_) {
    source_->reconnect(
        leonav::format("no byte for %.0f s: the connection may be dead", reconnect_after_s_));
  }
}

void Stream::tell_news() {
  for (const FormatNews& news : format_->take_news()) {
    spdlog::log(news.is_warning ? spdlog::level::warn : spdlog::level::info, "{}: {}", name_,
                news.text);
  }
}

void Stream::look_at_recording() {
  if (!recording_->flush()) return tell_recording_error();
  if (recording_->is_near_limit() && !std::exchange(limit_is_told_, true)) {
    spdlog::warn("{}: the recording will end soon: {} has nine tenths of its 'record_limit_mb'",
                 name_, recording_->path());
  }
  const std::uint64_t dropped = recording_->dropped_bytes();
  if (dropped == std::exchange(told_dropped_, dropped)) return;
  spdlog::warn("{}: the recording lacks {} bytes since the start: the disk of {} is too slow",
               name_, dropped, recording_->path());
}

// Once: the stream goes on without its recording, whose thread writes what is queued.
void Stream::tell_recording_error() {
  spdlog::error("{}: the recording ends: {}", name_, recording_->error());
  is_recording_ = false;
  recording_->end();
}

}  // namespace leonav
