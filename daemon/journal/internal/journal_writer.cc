#include "daemon/journal/internal/journal_writer.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/navigator/interface/event.h"
#include "daemon/config/effective_config.h"
#include "daemon/journal/internal/recorded_outputs.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/event_header.h"
#include "drivers/lcm/run_configuration.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

constexpr std::size_t kBufferBytes = 256 << 10;
constexpr std::size_t kMostEventBytes =
    kEventHeaderBytes + kMaxEventChannelBytes + wire::kMaxMessageBytes + 1;
constexpr std::int64_t kFirstRetryNs = 250'000'000, kLastRetryNs = 8 * kNanosecondsPerSecond;
// Share of the ring that waits, above which a full disk is made emptier.
constexpr double kCrowdedRing = 0.4;
// What a power cut costs at most, beside what was not written yet.
constexpr std::int64_t kSyncNs = 5 * kNanosecondsPerSecond;

std::vector<std::uint8_t> configuration_of(const DaemonConfig& config) {
  const ConfigOrigin& source = config.source;
  if (source.keys.empty()) return {};
  return encode(
      RunConfiguration{"leonavd " LEONAV_VERSION, source.name, effective_text(source), {}});
}

// What must not be overwritten later. A command asked for the first, and the second is good news.
bool is_fault(Channel channel, ByteSpan bytes) {
  if (channel != Channel::kEvent || bytes.size() <= wire::kEventCodeOffset) return false;
  const auto kind = static_cast<EventKind>(bytes[wire::kEventKindOffset]);
  const auto cause = static_cast<ResetCause>(bytes[wire::kEventCodeOffset]);
  if (kind == EventKind::kSmootherFailed) return true;
  return kind == EventKind::kFilterReset && cause != ResetCause::kCommand &&
         cause != ResetCause::kWindow;
}

}  // namespace

JournalWriter::JournalWriter(const DaemonConfig& config, JournalCounters* counters, KeptNames* kept,
                             DiskHook hook)
    : limits_(limits_of(config.journal)),
      counters_(counters),
      configuration_(configuration_of(config)),
      disk_(counters, std::move(hook)),
      pieces_(config.journal, &disk_, counters, kept),
      beginning_(configuration_.size() + 4096),
      buffer_(kBufferBytes),
      next_number_(configuration_.empty() ? 1 : 2),
      wanted_outputs_(recorded_outputs(config.journal.outputs)) {
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    channel_names_.push_back(channel_name(static_cast<Channel>(i), config.lcm.prefix));
  }
}

void JournalWriter::write_from(MessageRing* ring) {
  if (new_limits_.take(&limits_)) pieces_.set_limits(limits_);
  is_crowded_ = ring->waiting() > kCrowdedRing;
  if (!is_ready(false)) return;
  if (pieces_.has_pieces())
    wanted_outputs_.store(recorded_outputs(limits_.outputs), std::memory_order_relaxed);
  const auto take = [this](const MessageHeader& header, ByteSpan bytes) { append(header, bytes); };
  for (;;) {
    if (!change_outputs()) return;
    if (!buffer_.has_room(kMostEventBytes) && !flush()) return;
    if (!ring->consume_one(take)) break;
    if (!is_piece_full()) continue;
    end_piece();
    if (!begin_piece()) return;
  }
  if (static_cast<double>(since_flush_.nanoseconds()) * 1e-9 >= limits_.flush_interval_s) flush();
  if (since_sync_.nanoseconds() >= kSyncNs) secure();
  apply_keep();
}

bool JournalWriter::finish(MessageRing* ring, const LostMessages& lost, std::uint64_t sequence) {
  is_crowded_ = true;  // there is no later attempt
  if (!persist([&] { return write_all_of(ring); })) return false;
  const auto add = [this](Channel channel, ByteSpan bytes) {
    append({wall_clock_us(), static_cast<std::uint32_t>(bytes.size()), channel}, bytes);
  };
  if (lost.any()) add(Channel::kLost, encode_lost(lost, sequence));
  add(Channel::kEnd, encode_journal_end(next_number_));
  if (!persist([&] { return is_ready(true) && flush(); })) return false;
  apply_keep();
  const bool synchronized = sync();
  if (synchronized)
    pieces_.end(false);
  else
    fail(disk_.error());
  pieces_.file().close();
  return synchronized;
}

bool JournalWriter::write_all_of(MessageRing* ring) {
  if (!is_ready(true)) return false;
  const auto take = [this](const MessageHeader& header, ByteSpan bytes) { append(header, bytes); };
  for (;;) {
    if (!change_outputs()) return false;
    if (!buffer_.has_room(kMostEventBytes) && !flush()) return false;
    if (!ring->consume_one(take)) return flush();
  }
}

// Tries again for as long as each failure has made room.
template <typename Attempt>
bool JournalWriter::persist(Attempt&& attempt) {
  made_room_ = false;
  while (!attempt()) {
    if (!std::exchange(made_room_, false)) return false;
  }
  return true;
}

// Returns whether there is a piece to write to; begins one after a failure, when it is time to try.
bool JournalWriter::is_ready(bool at_once) {
  if (begun_) return true;
  const std::int64_t wait_ns =
      is_crowded_ ? std::min(retry_after_ns_, kFirstRetryNs) : retry_after_ns_;
  if (!at_once && monotonic_ns() - failed_at_ns_ < wait_ns) return false;
  return begin_piece();
}

bool JournalWriter::begin_piece() {
  if (!pieces_.open()) {
    fail(disk_.error());
    return false;
  }
  if (!write_beginning() || !flush()) return false;
  counters_->error.set(0);
  retry_after_ns_ = 0;
  counters_->pieces.add(1);
  pieces_.note_begun();
  return true;
}

bool JournalWriter::write_beginning() {
  beginning_.clear();
  const std::int64_t now_us = wall_clock_us();
  std::int64_t number = 0;
  if (!configuration_.empty())
    beginning_.append(number++, now_us, channel_name_of(Channel::kConfig), configuration_);
  PieceInfo info = pieces_.info();
  info.first = next_number_ - buffer_.events();
  beginning_.append(number, now_us, channel_name_of(Channel::kPiece), encode_piece(info));
  beginning_bytes_ = static_cast<std::int64_t>(beginning_.bytes().size());
  size_ = synced_size_ = 0;
  begun_ = true;
  if (!write_through(beginning_.bytes())) return false;
  counters_->piece_number.set(info.number);
  counters_->journaled.add(beginning_.events());
  since_begin_ = since_sync_ = Stopwatch();
  return true;
}

// The piece is complete. False: it fails, and what it lacks goes to another one like it.
bool JournalWriter::end_piece() {
  if (!flush()) return false;
  if (size_ > beginning_bytes_) {
    apply_keep();
    sync();
    pieces_.end(true);
  } else {
    pieces_.discard();
  }
  begun_ = false;
  return true;
}

// Begins a piece where others are to be written from now on. False: what waits has to wait on.
bool JournalWriter::change_outputs() {
  if (!next_outputs_) return true;
  if (!end_piece()) return false;
  pieces_.set_outputs(*std::exchange(next_outputs_, std::nullopt));
  return begin_piece();
}

void JournalWriter::append(const MessageHeader& header, ByteSpan bytes) {
  if (header.channel == Channel::kPiece) {
    next_outputs_ = static_cast<RecordedOutputs>(bytes[0]);
    return;
  }
  buffer_.append(next_number_++, header.timestamp_us, channel_name_of(header.channel), bytes);
  if (is_fault(header.channel, bytes)) keep();
}

bool JournalWriter::flush() {
  if (!begun_) return false;
  since_flush_ = Stopwatch();
  if (buffer_.empty()) return true;
  if (!write_through(buffer_.bytes())) return false;
  counters_->journaled.add(buffer_.events());
  buffer_.clear();
  return true;
}

bool JournalWriter::write_through(std::span<const std::uint8_t> bytes) {
  if (pieces_.file().write(bytes) < bytes.size()) {
    fail(disk_.error());
    return false;
  }
  size_ += static_cast<std::int64_t>(bytes.size());
  return true;
}

// Now and then: what is written goes to the disk, and a piece that was deleted or moved away, with
// its folder or alone, is followed by one under the path.
void JournalWriter::secure() {
  since_sync_ = Stopwatch();
  if (!begun_) return;
  if (!pieces_.is_in_place()) return fail(disk_.error() != 0 ? disk_.error() : ENOENT);
  if (size_ > synced_size_) sync();
}

// A disk that does not confirm what it has taken may still take what comes; so the piece goes on.
bool JournalWriter::sync() {
  synced_size_ = size_;
  if (pieces_.sync()) return true;
  counters_->unsynced.add(1);
  return false;
}

// Ends the piece with its last whole message, and says when to try the next one.
void JournalWriter::fail(int error) {
  counters_->error.set(error);
  counters_->last_error.set(error);
  counters_->failures.add(1);
  if (begun_) {
    pieces_.file().truncate(size_);
    if (size_ > beginning_bytes_)
      pieces_.end(false);
    else
      pieces_.discard();
  }
  begun_ = false;
  retry_after_ns_ =
      retry_after_ns_ == 0 ? kFirstRetryNs : std::min(2 * retry_after_ns_, kLastRetryNs);
  failed_at_ns_ = monotonic_ns();
  // A disk may be full for a while: nothing is deleted before the memory runs out.
  const bool full = error == ENOSPC || error == EDQUOT;
  made_room_ = full && is_crowded_ && pieces_.make_room();
}

bool JournalWriter::is_piece_full() const {
  if (!begun_ || !pieces_.has_pieces() || buffer_.empty()) return false;
  const auto size = size_ + static_cast<std::int64_t>(buffer_.bytes().size());
  return size >= bytes_of_megabytes(limits_.piece_mb) ||
         (limits_.piece_s > 0.0 &&
          static_cast<double>(since_begin_.nanoseconds()) * 1e-9 >= limits_.piece_s);
}

void JournalWriter::apply_keep() {
  if (keep_requested_.exchange(false, std::memory_order_relaxed)) pieces_.keep();
}

}  // namespace leonav
