// The SerialOutlet writes to a serial port, which it opens again after a failure.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/steady_timer.hpp>

#include "drivers/transport/live_sources.h"
#include "drivers/transport/retry_wait.h"
#include "tools/serve/outlet.h"
#include "tools/serve/stream_writer.h"

namespace leonav {

// 8 data bits, no parity, one stop bit, no flow control.
class SerialOutlet final : public Outlet {
 public:
  SerialOutlet(boost::asio::io_context* io, const SerialOptions& options);

  void send(const std::shared_ptr<const Batch>& batch) override;
  std::string status() const override;

 private:
  using Port = StreamWriter<boost::asio::serial_port>;
  void open();
  void try_later(const boost::system::error_code& error);

  boost::asio::io_context* io_;
  SerialOptions options_;
  boost::asio::steady_timer timer_;
  RetryWait wait_;
  std::shared_ptr<Port> port_;  // null while closed
  std::uint64_t lost_ = 0;      // of ports that were closed
};

}  // namespace leonav
