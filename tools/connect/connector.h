// The Connector runs all streams in one thread and publishes what they bring.
#pragma once
#include <memory>

#include "tools/connect/connect_config.h"

namespace leonav {

// How a run ended.
enum class ConnectorEnd : std::uint8_t {
  kStopped,  // by a signal
  kDone,     // every stream has ended, and something was published
  kFailed,   // every stream has ended, one of them with an error, or nothing was published
};

class Connector {
 public:
  // Opens LCM, files and recordings. Throws LcmError, FileError.
  explicit Connector(const ConnectConfig& config);
  ~Connector();

  // Runs until SIGTERM or SIGINT comes, or every stream has ended. A service manager that asks for
  // it is told of start, life and end (daemon/link/service_manager.h).
  ConnectorEnd run();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
