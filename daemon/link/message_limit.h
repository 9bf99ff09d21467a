// The MessageLimit keeps LCM from taking memory for messages that are too long to be inputs.
#pragma once
#include <cstdint>
#include <set>
#include <string>

namespace leonav {

// liblcm takes the memory for a message of many datagrams as soon as the first one claims a size,
// up to 256 MB, if it is of a channel that is subscribed to. From its construction until apply(),
// the object's owner lets liblcm open its sockets; apply() then has the kernel drop datagrams that
// belong to a longer message. So the channels are subscribed to after it.
class MessageLimit {
 public:
  MessageLimit();
  // Returns why there is no limit; empty: there is.
  std::string apply(std::uint32_t most_bytes) const;

 private:
  std::set<int> before_;
};

}  // namespace leonav
