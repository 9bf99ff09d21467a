// The InputEndpoint is standard input: a pipe, a terminal or a redirected file.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <string>

#include "drivers/transport/internal/endpoint.h"

namespace leonav {

class InputEndpoint final : public Endpoint {
 public:
  explicit InputEndpoint(boost::asio::io_context* io) : input_(*io) {}
  void open(Opened opened) override;
  void read(boost::asio::mutable_buffer buffer, Read done) override;
  void close() override;
  bool can_reopen() const override { return false; }
  std::string text_of(const boost::system::error_code& error) const override;

 private:
  boost::asio::posix::stream_descriptor input_;
};

}  // namespace leonav
