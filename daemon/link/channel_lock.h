// The ChannelLock keeps a second leonavd off the channels of the first one.
#pragma once
#include <string>

#include "daemon/config/daemon_config.h"

namespace leonav {

// Held for as long as the object lives, however the process ends. It is a Unix socket with an
// abstract name made of address and prefix, which exists once in a network namespace, as the
// multicast messages do. Daemons on different hosts do not see each other.
class ChannelLock {
 public:
  // Throws LcmError, which names the process that holds the lock. An address other than udpm is of
  // one process alone and is not locked.
  explicit ChannelLock(const LcmConfig& config);
  ~ChannelLock();
  ChannelLock(const ChannelLock&) = delete;
  ChannelLock& operator=(const ChannelLock&) = delete;

  // Takes the questions of other daemons that have asked who holds the lock; call it once a second.
  // Otherwise the system would let two of them ask, and no more.
  void let_ask() const;

 private:
  int descriptor_ = -1;
};

}  // namespace leonav
