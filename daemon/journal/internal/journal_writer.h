// The JournalWriter writes messages to the pieces of a journal, whatever the disk does meanwhile.
#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "daemon/journal/internal/event_buffer.h"
#include "daemon/journal/internal/piece_sequence.h"
#include "daemon/journal/journal_counters.h"
#include "daemon/journal/journal_limits.h"
#include "daemon/threads/latest_value.h"
#include "daemon/threads/message_ring.h"

namespace leonav {

// A piece that fails ends with the last message that was written whole. What the disk has not taken
// stays in memory and goes to the next piece, which is begun as soon as that can be done: a failure
// alone loses nothing, while there is room. The same holds for the first piece, which is begun by
// the first call. One thread; nothing is allocated after construction.
class JournalWriter {
 public:
  JournalWriter(const DaemonConfig& config, JournalCounters* counters, KeptNames* kept,
                DiskHook hook);

  // Writes what waits in the ring, as far as the disk takes it.
  void write_from(MessageRing* ring);
  // The same for the last time, with the end mark; returns whether everything is on the disk.
  // `lost`: what no mark counts as yet; `sequence`: of the mark that counts it.
  bool finish(MessageRing* ring, const LostMessages& lost, std::uint64_t sequence);
  // Asks, in any thread, that the present piece and the one before it are kept.
  void keep() { keep_requested_.store(true, std::memory_order_relaxed); }
  // Sets, in one other thread, the limits that hold from the next write_from() on.
  void set_limits(const JournalLimits& limits) { new_limits_.set(limits); }
  // Any thread: the outputs that the journal is to hold. Who pushes puts a message PIECE of one
  // byte, these outputs, before the first that is selected by them; a piece begins there.
  RecordedOutputs wanted_outputs() const { return wanted_outputs_.load(std::memory_order_relaxed); }

 private:
  bool write_all_of(MessageRing* ring);
  template <typename Attempt>
  bool persist(Attempt&& attempt);
  bool is_ready(bool at_once);
  bool begin_piece();
  bool write_beginning();
  bool end_piece();
  bool change_outputs();
  void append(const MessageHeader& header, ByteSpan bytes);
  bool flush();
  bool write_through(std::span<const std::uint8_t> bytes);
  void secure();
  bool sync();
  void fail(int error);
  bool is_piece_full() const;
  void apply_keep();
  std::string_view channel_name_of(Channel channel) const {
    return channel_names_[index_of(channel)];
  }

  JournalLimits limits_;
  LatestValue<JournalLimits> new_limits_;
  JournalCounters* counters_;
  std::vector<std::string> channel_names_;
  std::vector<std::uint8_t> configuration_;  // message CONFIG; empty: there is none
  DiskCalls disk_;
  PieceSequence pieces_;
  EventBuffer beginning_, buffer_;
  bool begun_ = false;     // the piece's beginning is written, or is being written
  std::int64_t size_ = 0;  // bytes of the piece that are written, whole messages
  std::int64_t synced_size_ = 0;
  std::int64_t beginning_bytes_ = 0;
  std::int64_t next_number_ = 0;
  Stopwatch since_flush_, since_begin_, since_sync_;
  std::int64_t failed_at_ns_ = 0, retry_after_ns_ = 0;  // retry_after_ns_ 0: nothing has failed
  std::atomic<bool> keep_requested_{false};
  std::atomic<RecordedOutputs> wanted_outputs_;
  std::optional<RecordedOutputs> next_outputs_;  // of the piece that is to begin now
  bool is_crowded_ = false;                      // much waits in the ring
  bool made_room_ = false;                       // the last failure has deleted a piece
};

}  // namespace leonav
