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

}  // namespace

Verifier::Verifier(const std::string& journal, const std::string& prefix, const JournalScan& scan)
    : prefix_(prefix), selection_(scan.outputs) {
  for (Group& group : groups_) group.log = std::make_unique<EventLogReader>(journal);
}

bool Verifier::next_recorded(std::size_t group) {
  Group& state = groups_[group];
  if (state.waits) return true;
  while (!state.ended) {
    if (!state.log->next(&state.event) || state.log->missing() > 0) {
      state.ended = true;
      break;
    }
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

void Verifier::compare(Channel channel, std::size_t group, ByteSpan regenerated) {
  if (!selection_.contains(channel, regenerated) || was_left_out(group)) {
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
    if (groups_[group].left_out > 0 && complete) {
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
