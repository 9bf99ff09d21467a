// The MessageLimit keeps LCM from taking memory for messages that are no inputs or too long.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace leonav {

// liblcm takes the memory for a message of many datagrams as soon as the first one claims a size,
// up to 256 MB, if it is of a channel that is subscribed to. And it keeps the name of every channel
// that it has seen. From its construction until apply(), the object's owner lets liblcm open its
// sockets; apply() then has the kernel drop datagrams of longer messages and of other channels. So
// the channels are subscribed to after it.
class MessageLimit {
 public:
  MessageLimit();
  // `channels`: full names, one at least. Returns why there is no limit; empty: there is.
  std::string apply(std::uint32_t most_bytes, const std::vector<std::string>& channels) const;

 private:
  std::set<int> before_;
};

}  // namespace leonav
