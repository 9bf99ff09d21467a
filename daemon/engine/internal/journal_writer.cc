#include "daemon/engine/internal/journal_writer.h"

#include "daemon/config/effective_config.h"
#include "daemon/engine/internal/journal_path.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/run_configuration.h"

namespace leonav {

JournalWriter::JournalWriter(const DaemonConfig* config, EngineCounters* counters)
    : config_(config), path_(config->journal.path), counters_(counters) {
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    channel_names_.push_back(channel_name(static_cast<Channel>(i), config_->lcm.prefix));
  }
}

void JournalWriter::open() {
  if (path_.empty()) return;
  path_ = claim_journal_path(path_);
  log_ = std::make_unique<EventLogWriter>(path_);
  write_configuration();
}

void JournalWriter::write_configuration() {
  const ConfigOrigin& source = config_->source;
  if (source.keys.empty()) return;
  const auto bytes =
      encode(RunConfiguration{"leonavd " LEONAV_VERSION, source.name, effective_text(source), {}});
  write({wall_clock_us(), static_cast<std::uint32_t>(bytes.size()), Channel::kConfig}, bytes);
}

void JournalWriter::write_end() {
  const auto bytes = encode_journal_end(log_ == nullptr ? 0 : log_->events());
  write({wall_clock_us(), static_cast<std::uint32_t>(bytes.size()), Channel::kEnd}, bytes);
}

void JournalWriter::write(const MessageHeader& header, ByteSpan bytes) {
  if (log_ == nullptr || counters_->journal_failed.get() != 0) return;
  if (log_->write(header.timestamp_us, channel_names_[index_of(header.channel)], bytes)) {
    counters_->journaled.add(1);
  } else {
    error_ = log_->error();
    counters_->journal_failed.set(1);
  }
}

void JournalWriter::flush(bool sync) {
  if (log_ == nullptr || counters_->journal_failed.get() != 0) return;
  if (log_->flush(sync)) return;
  error_ = log_->error();
  counters_->journal_failed.set(1);
}

void JournalWriter::finish() {
  write_end();
  flush(true);
}

}  // namespace leonav
