#include "tools/replay/verifier.h"

#include <algorithm>
#include <cstdio>

namespace leonav {
namespace {

std::string hex(std::uint8_t byte) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "%02x", byte);
  return text.data();
}

}  // namespace

Verifier::Verifier(const std::string& journal, const std::string& prefix) : prefix_(prefix) {
  for (Group& group : groups_) group.log = std::make_unique<EventLogReader>(journal);
}

bool Verifier::next_recorded(std::size_t group) {
  Group& state = groups_[group];
  while (!state.ended) {
    if (!state.log->next(&event_)) {
      state.ended = true;
      break;
    }
    const auto channel = channel_from_name(event_.channel, prefix_);
    if (!channel || output_group(*channel, event_.data) != group) continue;
    ++state.count;
    return true;
  }
  return false;
}

void Verifier::compare(std::size_t group, ByteSpan regenerated) {
  if (!next_recorded(group)) {
    ++beyond_end_;
    return;
  }
  ++compared_;
  const auto& recorded = event_.data;
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
    while (next_recorded(group)) differ(group, "recorded, but not regenerated");
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
