// The SerialEndpoint is a serial port or pseudo-terminal.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <string>

#include "drivers/transport/internal/endpoint.h"
#include "drivers/transport/live_sources.h"

namespace leonav {

class SerialEndpoint final : public Endpoint {
 public:
  SerialEndpoint(boost::asio::io_context* io, const SerialOptions& options)
      : options_(options), port_(*io) {}
  void open(Opened opened) override;
  void read(boost::asio::mutable_buffer buffer, Read done) override;
  void close() override;
  std::string text_of(const boost::system::error_code& error) const override;

 private:
  boost::system::error_code configure();

  SerialOptions options_;
  boost::asio::serial_port port_;
};

}  // namespace leonav
