// The MessageLimit keeps LCM from taking memory for messages that are no inputs or too long.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "daemon/link/datagram_filter.h"

namespace leonav {

// liblcm takes the memory for a message of many datagrams as soon as the first one claims a size,
// up to 256 MB, if it is of a channel that is subscribed to. And it keeps the name of every channel
// that it has seen. From its construction until apply(), the object's owner lets liblcm open its
// sockets; apply() then has the kernel drop datagrams of longer messages and of other channels. So
// the channels are subscribed to after it.
class MessageLimit {
 public:
  MessageLimit();
  // `channels`: one at least. Returns why there is no limit; empty: there is.
  std::string apply(const std::vector<ReceivedChannel>& channels) const;

 private:
  std::set<int> before_;
};

}  // namespace leonav
