// One list of inputs through Navigator or read back from a journal, and what came of it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/navigator/navigator.h"
#include "daemon/messages/encoding_sink.h"
#include "daemon/messages/input_dispatch.h"
#include "daemon/messages/output_groups.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"

namespace leonav::test {

using Bytes = std::vector<std::uint8_t>;

struct Collector final : MessageTarget {
  std::array<std::vector<Bytes>, kOutputGroups.size()> groups;
  void take(Channel channel, ByteSpan bytes) override {
    if (const auto group = output_group(channel, bytes)) {
      groups[*group].emplace_back(bytes.begin(), bytes.end());
    }
  }
};

inline std::vector<std::uint64_t> missed_epochs(const Collector& outputs) {
  Decoder decoder;
  std::vector<std::uint64_t> missed;
  for (const Bytes& bytes : outputs.groups[1]) {
    Decision decision;
    REQUIRE(decoder.decode(bytes, &decision).fault == InputFault::kNone);
    if (!decision.committed) missed.push_back(decision.epoch);
  }
  return missed;
}

// As a replay does it.
inline Collector run_navigator(const NavigatorConfig& config, const std::vector<Input>& list,
                               const std::vector<Decision>& recorded) {
  Collector outputs;
  EncodingSink sink(&outputs);
  Navigator navigator(config, &sink);
  for (const Decision& decision : recorded) navigator.record(decision);
  InputDispatch dispatch(&navigator.sequencer());
  for (const Input& input : list) dispatch.dispatch(input.channel, input.bytes);
  return outputs;
}

inline Collector run_navigator(const std::vector<Input>& list,
                               const std::vector<std::uint64_t>& missed) {
  std::vector<Decision> decisions(missed.size());
  for (std::size_t i = 0; i < missed.size(); ++i) decisions[i].epoch = missed[i];
  return run_navigator(drive_config().navigator, list, decisions);
}

// A minute's drive as messages; `keep` may leave one out.
template <typename Keep>
std::vector<Input> drive_messages(Keep keep) {
  std::vector<Input> made;
  feed_messages(synthetic_drive(noisy_drive(60.0)), [&](Channel channel, ByteSpan bytes) {
    if (keep(channel)) made.push_back({channel, Bytes(bytes.begin(), bytes.end())});
  });
  return made;
}

inline std::vector<Input> read_journal_inputs(const std::string& path) {
  EventLogReader log(path);
  std::vector<Input> list;
  LogEvent event;
  while (log.next(&event)) {
    const auto channel = channel_from_name(event.channel);
    REQUIRE(channel.has_value());
    if (is_replayed(*channel)) list.push_back({*channel, event.data});
  }
  CHECK_FALSE(log.truncated());
  return list;
}

inline void check_same(const Collector& a, const Collector& b) {
  for (std::size_t group = 0; group < kOutputGroups.size(); ++group) {
    INFO(kOutputGroups[group]);
    REQUIRE(a.groups[group].size() == b.groups[group].size());
    CHECK(a.groups[group] == b.groups[group]);
  }
}

}  // namespace leonav::test
