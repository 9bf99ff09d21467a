#include "tools/replay/verifier.h"

#include <algorithm>
#include <cstdio>

#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

std::string hex(std::uint8_t byte) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "%02x", byte);
  return text.data();
}

// Which outputs the journal holds, as far as it has been read.
RecordedOutputs outputs_of(const EventLogReader& log) {
  return log.piece() ? log.piece()->outputs : RecordedOutputs::kAll;
}

// Whether two journals with these outputs hold other messages of the group.
bool hold_different(std::size_t group, RecordedOutputs a, RecordedOutputs b) {
  if (group == kSolutionGroup) return a != b;
  const bool is_left_out = group == kEpochGroup || group == kSmoothedGroup;
  return is_left_out && (a == RecordedOutputs::kNone) != (b == RecordedOutputs::kNone);
}

}  // namespace

Verifier::Verifier(const std::string& journal, const std::string& prefix) : prefix_(prefix) {
  for (Group& group : groups_) {
    group.log = std::make_unique<EventLogReader>(journal);
    group.selection = OutputSelection(outputs_of(*group.log));
  }
}

bool Verifier::next_recorded(std::size_t group) {
  Group& state = groups_[group];
  if (state.waits) return true;
  while (!state.ended) {
    if (!state.log->next(&state.event) || state.log->missing() > 0) {
      state.ended = true;
      break;
    }
    if (hold_different(group, outputs_of(*state.log), state.selection.outputs()))
      state.changes = true;
    const auto channel = channel_from_name(state.event.channel, prefix_);
    if (!channel) continue;
    if (*channel == Channel::kLost) {
      const auto lost = decode_lost(state.event.data);
      if (lost && group == kSolutionGroup) state.left_out += lost->solutions;
      state.ended = lost && lost->others > 0;
    }
    if (output_group(*channel, state.event.data) != group) continue;
    ++state.count;
    state.waits = true;
    return true;
  }
  return false;
}

// A mark stands behind those that it counts and before the next SOLUTION that is recorded.
bool Verifier::was_left_out(std::size_t group) {
  next_recorded(group);
  if (groups_[group].left_out == 0) return false;
  --groups_[group].left_out;
  return true;
}

// Where the outputs that are recorded change, nothing says how many are not: the next one that is
// recorded tells where it begins again. What neither piece holds is passed over, and with it what
// would be missing right at the change.
bool Verifier::begins_again(Group* state, ByteSpan regenerated) {
  const auto& recorded = state->event.data;
  if (!state->waits ||
      !std::equal(regenerated.begin(), regenerated.end(), recorded.begin(), recorded.end()))
    return false;
  state->selection = OutputSelection(outputs_of(*state->log));
  state->changes = false;
  state->left_out = 0;
  return true;
}

bool Verifier::is_recorded(Channel channel, std::size_t group, ByteSpan regenerated) {
  Group& state = groups_[group];
  next_recorded(group);
  if (state.changes && !begins_again(&state, regenerated)) return false;
  return state.selection.contains(channel, regenerated) && !was_left_out(group);
}

void Verifier::compare(Channel channel, std::size_t group, ByteSpan regenerated) {
  if (!is_recorded(channel, group, regenerated)) {
    ++unrecorded_;
    return;
  }
  if (!next_recorded(group)) {
    ++beyond_end_;  // behind the last one that was recorded
    return;
  }
  ++compared_;
  groups_[group].waits = false;
  const auto& recorded = groups_[group].event.data;
  const auto [mine, theirs] =
      std::mismatch(regenerated.begin(), regenerated.end(), recorded.begin(), recorded.end());
  if (mine == regenerated.end() && theirs == recorded.end()) return;
  const auto offset = static_cast<std::size_t>(mine - regenerated.begin());
  std::string what = "at byte " + std::to_string(offset) + ": ";
  if (offset < regenerated.size() && offset < recorded.size()) {
    what += "recorded " + hex(recorded[offset]) + ", regenerated " + hex(regenerated[offset]);
  } else {
    what += "recorded " + std::to_string(recorded.size()) + " bytes, regenerated " +
            std::to_string(regenerated.size());
  }
  differ(group, what);
}

void Verifier::finish(bool complete) {
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    for (; next_recorded(group); groups_[group].waits = false)
      differ(group, "recorded, but not regenerated");
    if (groups_[group].left_out > 0 && !groups_[group].changes && complete) {
      differ(group,
             "is the last, and " + std::to_string(groups_[group].left_out) +
                 " more were left out of the journal, as its marks say, but not regenerated");
    }
  }
  if (beyond_end_ > 0 && complete) {
    differences_ += beyond_end_;
    if (first_difference_.empty()) {
      first_difference_ = std::to_string(beyond_end_) + " outputs regenerated, but not recorded";
    }
  }
}

void Verifier::differ(std::size_t group, const std::string& what) {
  ++differences_;
  if (!first_difference_.empty()) return;
  first_difference_ = std::string(kOutputGroups[group]) + " message " +
                      std::to_string(groups_[group].count) + " " + what;
}

}  // namespace leonav
