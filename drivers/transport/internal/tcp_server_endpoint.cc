#include "drivers/transport/internal/tcp_server_endpoint.h"

#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <utility>

#include "drivers/transport/internal/listen_text.h"

namespace leonav {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

error_code TcpServerEndpoint::listen() {
  error_code error;
  const asio::ip::address address = asio::ip::make_address(options_.address, error);
  if (error) return error;
  const tcp::endpoint place(address, options_.port);
  acceptor_.open(place.protocol(), error);
  if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(place, error);
  if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
  if (error) {
    error_code ignored;
    acceptor_.close(ignored);
  }
  return error;
}

void TcpServerEndpoint::open(Opened opened) {
  if (!acceptor_.is_open()) {
    if (const error_code error = listen()) {
      asio::post(acceptor_.get_executor(), [opened = std::move(opened), error] { opened(error); });
      return;
    }
  }
  // A client may have been accepted just when waiting for it was given up.
  error_code ignored;
  client_.close(ignored);
  acceptor_.async_accept(client_, [this, opened = std::move(opened)](const error_code& error) {
    error_code unset;
    if (!error) client_.set_option(asio::socket_base::keep_alive(true), unset);
    opened(error);
  });
}

void TcpServerEndpoint::read(asio::mutable_buffer buffer, Read done) {
  client_.async_read_some(buffer, std::move(done));
}

void TcpServerEndpoint::close() {
  error_code ignored;
  if (acceptor_.is_open()) acceptor_.cancel(ignored);
  client_.close(ignored);
}

// The next client need not wait because one has gone.
RetryBounds TcpServerEndpoint::retry_bounds() const {
  if (acceptor_.is_open()) return {.least_s = 0.0, .most_s = 0.1};
  return {};
}

std::string TcpServerEndpoint::text_of(const error_code& error) const {
  const std::string what = options_.address + ":" + std::to_string(options_.port) + ": ";
  if (error == asio::error::timed_out)
    return what + "no client is connected; the next one is awaited";
  if (error == asio::error::eof || error == asio::error::connection_reset) {
    return what + "the client closed the connection; the next one is awaited";
  }
  return what + listen_text(error);
}

}  // namespace leonav
