// The AnswerMonitor finds a daemon whose threads work and whose answer stands still all the same.
#pragma once
#include <cstdint>

#include "daemon/engine/engine.h"

namespace leonav {

// Nothing in leonavd is known that would bring it there. If it happens, only a restart helps: then
// the watchdog is not fed.
class AnswerMonitor {
 public:
  AnswerMonitor(Engine* engine, const NavigatorConfig& config);

  // Returns whether there has been an answer, good inputs of each kind that it needs come,
  // satellites are used, and yet no new SOLUTION has come for a minute, or for two and a half of
  // the configured intervals where that is longer. Call it once a second. Once no IMU sample has
  // been used for a minute, the answer needs epochs alone, which must be used.
  //
  // An input is good if it is used. Where no input of any kind is used, one that is refused for its
  // time alone is good too: a Sequencer that is wrong about the time refuses everything. Where it
  // uses IMU samples and refuses epochs, their senders disagree about the time. Other faults are
  // the sender's (bytes that nobody can read, values that nothing measures, the same stamp again):
  // they would be there after a restart too.
  bool stands_still();

 private:
  Engine* engine_;
  bool expects_imu_;
  double most_looks_;
  std::int64_t solution_ns_ = 0, imu_ = 0, epochs_ = 0;
  std::int64_t refused_imu_ = 0, refused_epochs_ = 0;  // for their time
  int seconds_without_imu_ = 0;
  int looks_ = 0;  // without a new solution although inputs came
};

}  // namespace leonav
