#include "daemon/journal/internal/journal_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/navigator/interface/event.h"
#include "daemon/config/effective_config.h"
#include "daemon/journal/internal/journal_path.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/event_header.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/piece_name.h"
#include "drivers/lcm/run_configuration.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

constexpr std::size_t kBufferBytes = 256 << 10;
constexpr std::size_t kMostEventBytes =
    kEventHeaderBytes + kMaxEventChannelBytes + wire::kMaxMessageBytes + 1;
constexpr std::int64_t kFirstRetryNs = 250'000'000, kLastRetryNs = 8 * kNanosecondsPerSecond;
// Share of the ring that waits, above which a full disk is made emptier.
constexpr double kCrowded = 0.4;
constexpr int kMostNamesTried = 100;

std::vector<std::uint8_t> configuration_of(const DaemonConfig& config) {
  const ConfigOrigin& source = config.source;
  if (source.keys.empty()) return {};
  return encode(
      RunConfiguration{"leonavd " LEONAV_VERSION, source.name, effective_text(source), {}});
}

RecordedOutputs recorded(JournalOutputs outputs) {
  switch (outputs) {
    case JournalOutputs::kThinned:
      return RecordedOutputs::kThinned;
    case JournalOutputs::kNone:
      return RecordedOutputs::kNone;
    default:
      return RecordedOutputs::kAll;
  }
}

std::int64_t bytes_of(double megabytes) { return static_cast<std::int64_t>(megabytes * 1e6); }

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

JournalWriter::JournalWriter(const DaemonConfig& config, JournalCounters* counters,
                             std::function<int()> before_call)
    : config_(config.journal),
      counters_(counters),
      configuration_(configuration_of(config)),
      file_(counters, std::move(before_call)),
      beginning_(configuration_.size() + 4096),
      buffer_(kBufferBytes) {
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    channel_names_.push_back(channel_name(static_cast<Channel>(i), config.lcm.prefix));
  }
}

void JournalWriter::open() {
  path_ = claim_journal_path(config_.path);
  name_ = std::filesystem::path(path_).filename();
  piece_.run = wall_clock_us();
  piece_.outputs = recorded(config_.outputs);
  next_number_ = configuration_.empty() ? 1 : 2;
  const auto fail = [this](int error) {
    throw EventLogError(path_ + ": cannot be created: " + std::strerror(error));
  };
  if (name_.empty()) fail(EISDIR);
  if (!format_piece_name({name_}, piece_name_)) fail(ENAMETOOLONG);
  // Before the folder is read: the reason is a better one.
  if (!file_.open(AT_FDCWD, path_.c_str(), false) && !file_.open(AT_FDCWD, path_.c_str(), true))
    fail(file_.error());
  folder_ = std::make_unique<PieceFolder>(config_.path, counters_);
  folder_->set_current(piece_name_.data());
  if (!file_.is_regular()) return;
  if (config_.kept_mb > 0.0) folder_->keep_crashed_run();
  folder_->limit(true, bytes_of(config_.kept_mb));
  if (config_.total_mb > 0.0)
    folder_->limit(false, bytes_of(config_.total_mb) - 2 * bytes_of(config_.piece_mb));
}

void JournalWriter::write_from(MessageRing* ring) {
  is_crowded_ = ring->waiting() > kCrowded;
  if (!is_ready(false)) return;
  const auto take = [this](const MessageHeader& header, ByteSpan bytes) { append(header, bytes); };
  for (;;) {
    if (!buffer_.has_room(kMostEventBytes) && !flush()) return;
    if (!ring->consume_one(take)) break;
    if (!is_piece_full()) continue;
    end_piece();
    if (!begin_piece()) return;
  }
  if (static_cast<double>(since_flush_.nanoseconds()) * 1e-9 >= config_.flush_interval_s) flush();
  apply_keep();
}

bool JournalWriter::finish(MessageRing* ring, const LostMessages& lost) {
  is_crowded_ = true;  // there is no later attempt
  if (!persist([&] { return write_all_of(ring); })) return false;
  const auto add = [this](Channel channel, ByteSpan bytes) {
    append({wall_clock_us(), static_cast<std::uint32_t>(bytes.size()), channel}, bytes);
  };
  if (lost.any()) add(Channel::kLost, encode_lost(lost, 0));
  add(Channel::kEnd, encode_journal_end(next_number_));
  if (!persist([&] { return is_ready(true) && flush(); })) return false;
  apply_keep();
  const bool synchronized = file_.sync();
  if (!synchronized) fail(file_.error());
  if (keeps_piece_) folder_->keep(piece_name_.data());
  file_.close();
  return synchronized;
}

bool JournalWriter::write_all_of(MessageRing* ring) {
  if (!is_ready(true)) return false;
  const auto take = [this](const MessageHeader& header, ByteSpan bytes) { append(header, bytes); };
  for (;;) {
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
  if (!file_.is_open() && !open_piece()) {
    fail(file_.error());
    return false;
  }
  if (!write_beginning() || !flush()) return false;
  counters_->error.set(0);
  retry_after_ns_ = 0;
  counters_->pieces.add(1);
  return true;
}

// What is no file on a disk has no pieces: it is opened again, under its name.
bool JournalWriter::open_piece() {
  if (!file_.is_regular()) return file_.open(AT_FDCWD, path_.c_str(), false);
  // The first one has its name already, and is empty as yet.
  if (!first_begun_) {
    if (!file_.open(folder_->descriptor(), piece_name_.data(), false)) return false;
    file_.truncate(0);
    return true;
  }
  for (int i = 0; i < kMostNamesTried; ++i) {
    ++piece_.number;
    if (!format_piece_name({name_, piece_.number}, piece_name_)) return false;
    if (file_.open(folder_->descriptor(), piece_name_.data(), true)) {
      folder_->set_current(piece_name_.data());
      return true;
    }
    if (file_.error() == EEXIST) continue;  // not ours
    --piece_.number;
    return false;
  }
  return false;
}

bool JournalWriter::write_beginning() {
  beginning_.clear();
  const std::int64_t now_us = wall_clock_us();
  std::int64_t number = 0;
  if (!configuration_.empty())
    beginning_.append(number++, now_us, channel_name_of(Channel::kConfig), configuration_);
  piece_.first = next_number_ - buffer_.events();
  beginning_.append(number, now_us, channel_name_of(Channel::kPiece), encode_piece(piece_));
  size_ = 0;
  begun_ = true;
  if (!write_through(beginning_.bytes())) return false;
  counters_->piece_number.set(piece_.number);
  counters_->journaled.add(beginning_.events());
  beginning_bytes_ = size_;
  first_begun_ = true;
  since_begin_ = Stopwatch();
  return true;
}

// The piece is complete.
void JournalWriter::end_piece() {
  if (!flush()) return;
  apply_keep();
  if (!file_.sync()) counters_->failures.add(1);
  file_.close();
  begun_ = false;
  note_ended_piece();
  // The piece that has just ended stays, whatever the limits are.
  folder_->set_current(piece_name_.data());
  // One for the one that is about to be written: a disk smaller than the limits.
  if (folder_->free_bytes() < bytes_of(config_.piece_mb)) folder_->delete_oldest();
  folder_->limit(true, bytes_of(config_.kept_mb));
  if (config_.total_mb > 0.0)
    folder_->limit(false, bytes_of(config_.total_mb) - bytes_of(config_.piece_mb));
}

void JournalWriter::note_ended_piece() {
  last_piece_name_ = {};
  if (keeps_piece_)
    folder_->keep(piece_name_.data());
  else
    last_piece_name_ = piece_name_;
  keeps_piece_ = false;
}

void JournalWriter::append(const MessageHeader& header, ByteSpan bytes) {
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
  if (file_.write(bytes) < bytes.size()) {
    fail(file_.error());
    return false;
  }
  size_ += static_cast<std::int64_t>(bytes.size());
  return true;
}

// Ends the piece with its last whole message, and says when to try the next one.
void JournalWriter::fail(int error) {
  counters_->failures.add(1);
  counters_->error.set(error);
  const bool empty = size_ <= beginning_bytes_;
  if (file_.is_open()) {
    file_.truncate(size_);
    file_.close();
    if (begun_ && file_.is_regular() && empty && piece_.number > 1) {
      // A piece without a message would only be in the way.
      unlinkat(folder_->descriptor(), piece_name_.data(), 0);
      --piece_.number;
    }
  }
  if (begun_ && !empty) note_ended_piece();
  begun_ = false;
  retry_after_ns_ =
      retry_after_ns_ == 0 ? kFirstRetryNs : std::min(2 * retry_after_ns_, kLastRetryNs);
  failed_at_ns_ = monotonic_ns();
  // A disk may be full for a while: nothing is deleted before the memory runs out.
  const bool full = error == ENOSPC || error == EDQUOT;
  made_room_ = full && is_crowded_ && file_.is_regular() && folder_->delete_oldest();
}

bool JournalWriter::is_piece_full() const {
  if (!begun_ || !file_.is_regular() || buffer_.empty()) return false;
  const auto size = size_ + static_cast<std::int64_t>(buffer_.bytes().size());
  return size >= bytes_of(config_.piece_mb) ||
         (config_.piece_s > 0.0 &&
          static_cast<double>(since_begin_.nanoseconds()) * 1e-9 >= config_.piece_s);
}

// The piece before is renamed at once, the present one when it ends.
void JournalWriter::apply_keep() {
  if (!keep_requested_.exchange(false, std::memory_order_relaxed)) return;
  if (config_.kept_mb <= 0.0 || !file_.is_regular()) return;
  keeps_piece_ = true;
  if (last_piece_name_[0] != '\0') folder_->keep(last_piece_name_.data());
  last_piece_name_ = {};
}

}  // namespace leonav
