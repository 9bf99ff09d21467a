#include "tools/replay/journal_scan.h"

#include <optional>

#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"

namespace leonav {

std::uint64_t JournalScan::inputs() const {
  std::uint64_t sum = 0;
  for (const Channel channel : kInputChannels) sum += messages[index_of(channel)];
  return sum;
}

bool JournalScan::is_journal() const {
  return messages[index_of(Channel::kConfig)] + messages[index_of(Channel::kDecision)] +
             messages[index_of(Channel::kEnd)] >
         0;
}

std::string JournalScan::describe() const {
  std::string text = "inputs:";
  for (const Channel channel : kInputChannels) {
    text += (channel == kInputChannels.front() ? " " : ", ") + std::string(name_of(channel)) + " " +
            std::to_string(messages[index_of(channel)]);
  }
  return text;
}

namespace {

void note_answer(ByteSpan bytes, Decoder* decoder, JournalScan* scan) {
  SmootherReport report;
  if (decoder->decode(bytes, &report).fault != InputFault::kNone) return;
  scan->delivered.push_back(decision_of(report));
}

void note_loss(ByteSpan bytes, JournalScan* scan) {
  const auto lost = decode_lost(bytes);
  if (!lost) return;
  scan->lost.solutions += lost->solutions;
  scan->lost.others += lost->others;
}

}  // namespace

std::vector<std::string> JournalScan::losses() const {
  std::vector<std::string> list;
  const auto count = [](auto number) { return std::to_string(number); };
  if (first_piece > 1) {
    list.push_back("the log begins with piece " + count(first_piece) +
                   " of its run, and no piece can be replayed as it ran without those before it: "
                   "the state in which it begins follows from them. The replay begins as the "
                   "service would that is started there. Where the first piece is still there, "
                   "give that one");
  }
  if (missing > 0)
    list.push_back(count(missing) + " messages are missing with pieces that are gone");
  if (lost.others > 0) {
    list.push_back(count(lost.others) +
                   " messages are missing which the disk did not take in time. From the first of "
                   "them on the replay is another run");
  }
  if (lost.solutions > 0) {
    list.push_back(count(lost.solutions) +
                   " SOLUTION were not recorded because the disk was too slow; they are "
                   "regenerated");
  }
  return list;
}

JournalScan scan_journal(const std::string& path, const std::string& prefix) {
  EventLogReader log(path);
  Decoder decoder;
  JournalScan scan;
  LogEvent event;
  std::optional<OutputSchema> schema;
  if (const auto& piece = log.first_piece()) {
    scan.first_piece = piece->number;
  }
  for (std::int64_t before = 0; log.next(&event); ++before) {
    const auto channel = channel_from_name(event.channel, prefix);
    if (!channel) {
      ++scan.other_messages;
      scan.stopped_cleanly = false;
      continue;
    }
    ++scan.messages[index_of(*channel)];
    scan.stopped_cleanly = *channel == Channel::kEnd && decode_journal_end(event.data) == before;
    if (!schema) schema = output_schema_of(*channel, event.data);
    if (*channel == Channel::kLost) note_loss(event.data, &scan);
    scan.missing = log.missing();
    if (scan.is_broken()) continue;
    if (*channel == Channel::kSmoother) note_answer(event.data, &decoder, &scan);
    if (*channel != Channel::kDecision) continue;
    Decision decision;
    if (decoder.decode(event.data, &decision).fault != InputFault::kNone) {
      ++scan.unreadable_decisions;
    } else {
      scan.decisions.push_back(decision);
    }
  }
  scan.output_schema = schema.value_or(OutputSchema::kNewest);
  scan.truncated = log.truncated();
  return scan;
}

}  // namespace leonav
