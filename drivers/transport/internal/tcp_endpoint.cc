#include "drivers/transport/internal/tcp_endpoint.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/error.hpp>
#include <utility>

#include "drivers/transport/internal/network_text.h"

namespace leonav {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

void TcpEndpoint::open(Opened opened) {
  const std::uint64_t attempt = ++attempt_;
  lookup_.start([this, attempt, opened = std::move(opened)](
                    const error_code& error, const NameLookup::Results& found) mutable {
    if (error) return opened(error);
    asio::async_connect(socket_, found,
                        [this, attempt, opened = std::move(opened)](const error_code& failed,
                                                                    const tcp::endpoint&) {
                          if (attempt != attempt_) return opened(asio::error::operation_aborted);
                          error_code ignored;
                          if (!failed)
                            socket_.set_option(asio::socket_base::keep_alive(true), ignored);
                          opened(failed);
                        });
  });
}

void TcpEndpoint::read(asio::mutable_buffer buffer, Read done) {
  socket_.async_read_some(buffer, std::move(done));
}

void TcpEndpoint::close() {
  error_code ignored;
  ++attempt_;
  lookup_.cancel();
  socket_.close(ignored);
}

std::string TcpEndpoint::text_of(const error_code& error) const {
  return options_.host + ":" + std::to_string(options_.port) + ": " +
         (error == asio::error::timed_out && lookup_.is_asking() ? mute_name_server_text()
                                                                 : network_text(error));
}

}  // namespace leonav
