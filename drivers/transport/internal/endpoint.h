// An Endpoint is what a Connection opens, reads and closes: a port, a socket, a pipe.
#pragma once
#include <boost/asio/buffer.hpp>
#include <boost/system/error_code.hpp>
#include <cstddef>
#include <functional>
#include <string>

#include "drivers/transport/retry_wait.h"

namespace leonav {

class Endpoint {
 public:
  using Opened = std::function<void(const boost::system::error_code&)>;
  using Read = std::function<void(const boost::system::error_code&, std::size_t)>;

  virtual ~Endpoint() = default;
  // Both call back from the io_context, never before they return; after close() with an error or
  // not at all.
  virtual void open(Opened opened) = 0;
  virtual void read(boost::asio::mutable_buffer buffer, Read done) = 0;
  virtual void close() = 0;
  // Whether it can be opened again after it failed or ended.
  virtual bool can_reopen() const { return true; }
  // Whether it can be dead while it looks open, as a connection over a network can.
  virtual bool can_be_half_open() const { return false; }
  // Whether being opened takes as long as nobody connects to it, which is no failure.
  virtual bool waits_for_peer() const { return false; }
  // How long to wait, after what has just failed, until it is opened again.
  virtual RetryBounds retry_bounds() const { return {}; }
  // What it is and what failed, with a remedy: a sentence without a full stop.
  virtual std::string text_of(const boost::system::error_code& error) const = 0;
};

}  // namespace leonav
