#include "drivers/transport/internal/tcp_endpoint.h"

#include <boost/asio/connect.hpp>
#include <utility>

namespace leonav {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

void TcpEndpoint::open(Opened opened) {
  resolver_.async_resolve(
      options_.host, std::to_string(options_.port),
      [this, opened = std::move(opened)](const error_code& error,
                                         const tcp::resolver::results_type& found) mutable {
        if (error) return opened(error);
        asio::async_connect(
            socket_, found,
            [this, opened = std::move(opened)](const error_code& failed, const tcp::endpoint&) {
              error_code ignored;
              if (!failed) {
                socket_.set_option(asio::socket_base::keep_alive(true), ignored);
              }
              opened(failed);
            });
      });
}

void TcpEndpoint::read(asio::mutable_buffer buffer, Read done) {
  socket_.async_read_some(buffer, std::move(done));
}

void TcpEndpoint::close() {
  error_code ignored;
  resolver_.cancel();
  socket_.close(ignored);
}

std::string TcpEndpoint::text_of(const error_code& error) const {
  const std::string what = options_.host + ":" + std::to_string(options_.port) + ": ";
  if (error == asio::error::host_not_found || error == asio::error::host_not_found_try_again) {
    return what + "the name is not known; check 'host' and the name server";
  }
  if (error == asio::error::connection_refused) {
    return what + "nothing listens there; is the server running, and is 'port' right?";
  }
  if (error == asio::error::timed_out) {
    return what + "does not answer; check the cable, 'host' and the firewall";
  }
  if (error == asio::error::eof) return what + "the server closed the connection";
  return what + error.message();
}

}  // namespace leonav
