// An Outlet is one kind of way out: a TCP server, a UDP destination, a serial port, a pseudo-
// terminal.
#pragma once
#include <memory>
#include <string>

#include "tools/serve/output_queue.h"

namespace leonav {

class Outlet {
 public:
  virtual ~Outlet() = default;
  // Never blocks.
  virtual void send(const std::shared_ptr<const Batch>& batch) = 0;
  // One line for logs: who reads, and what was lost.
  virtual std::string status() const = 0;
};

}  // namespace leonav
