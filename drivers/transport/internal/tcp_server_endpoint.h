// The TcpServerEndpoint listens, and is one client that connects after the other.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>

#include "drivers/transport/internal/endpoint.h"
#include "drivers/transport/live_sources.h"

namespace leonav {

// It is open while a client is connected. Further clients wait until that one has gone: their
// connections stand, and what they send is kept by the host as far as its buffers reach.
class TcpServerEndpoint final : public Endpoint {
 public:
  TcpServerEndpoint(boost::asio::io_context* io, const ListenOptions& options)
      : options_(options), acceptor_(*io), client_(*io) {}
  void open(Opened opened) override;
  void read(boost::asio::mutable_buffer buffer, Read done) override;
  // Goes on listening.
  void close() override;
  bool can_be_half_open() const override { return true; }
  bool waits_for_peer() const override { return true; }
  RetryBounds retry_bounds() const override;
  std::string text_of(const boost::system::error_code& error) const override;

 private:
  boost::system::error_code listen();

  ListenOptions options_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::ip::tcp::socket client_;
};

}  // namespace leonav
