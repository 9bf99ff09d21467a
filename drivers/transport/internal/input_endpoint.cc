#include "drivers/transport/internal/input_endpoint.h"

#include <unistd.h>

#include <boost/asio/post.hpp>
#include <cerrno>
#include <utility>

namespace leonav {

namespace asio = boost::asio;
using boost::system::error_code;

void InputEndpoint::open(Opened opened) {
  error_code error;
  const int copy = dup(STDIN_FILENO);
  if (copy < 0) {
    error.assign(errno, boost::system::system_category());
  } else {
    input_.assign(copy, error);
    if (error) ::close(copy);
  }
  asio::post(input_.get_executor(), [opened = std::move(opened), error] { opened(error); });
}

void InputEndpoint::read(asio::mutable_buffer buffer, Read done) {
  input_.async_read_some(buffer, std::move(done));
}

void InputEndpoint::close() {
  error_code ignored;
  input_.close(ignored);
}

std::string InputEndpoint::text_of(const error_code& error) const {
  return "standard input: " + error.message();
}

}  // namespace leonav
