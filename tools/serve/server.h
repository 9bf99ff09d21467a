// The Server receives solutions from LCM and writes their sentences to all outlets, in one thread.
#pragma once
#include <memory>

#include "tools/serve/serve_config.h"

namespace leonav {

class Server {
 public:
  // Opens LCM and all outlets. Throws LcmError, FileError, std::runtime_error.
  explicit Server(const ServeConfig& config);
  ~Server();

  // Runs until SIGTERM or SIGINT comes. Returns false where LCM has failed.
  bool run();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
