#include "tools/serve/serial_outlet.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

namespace leonav {

namespace asio = boost::asio;
using boost::system::error_code;

SerialOutlet::SerialOutlet(asio::io_context* io, const SerialOptions& options)
    : io_(io), options_(options), timer_(*io) {
  open();
}

void SerialOutlet::open() {
  using Base = asio::serial_port_base;
  asio::serial_port port(*io_);
  error_code error;
  port.open(options_.device, error);
  const auto set = [&](auto option) {
    if (!error) port.set_option(option, error);
  };
  set(Base::baud_rate(options_.baud));
  set(Base::character_size(8));
  set(Base::parity(Base::parity::none));
  set(Base::stop_bits(Base::stop_bits::one));
  set(Base::flow_control(Base::flow_control::none));
  if (error) return try_later(error);
  port_ = std::make_shared<Port>(std::move(port), options_.device);
  port_->start([this](const error_code& reason) {
    lost_ += port_->lost_sentences();
    port_.reset();
    try_later(reason);
  });
  spdlog::info("{}: open at {} baud", options_.device, options_.baud);
}

void SerialOutlet::try_later(const error_code& error) {
  const double wait_s = wait_.next_s();
  spdlog::warn(
      "{}: cannot be written ({}); is it plugged in, free, and may this user open it (group "
      "dialout)? Tried again in {} s",
      options_.device, error.message(), wait_s);
  timer_.expires_after(std::chrono::milliseconds(static_cast<long>(wait_s * 1e3)));
  timer_.async_wait([this](const error_code& cancelled) {
    if (!cancelled) open();
  });
}

void SerialOutlet::send(const std::shared_ptr<const Batch>& batch) {
  if (port_) port_->send(batch);
}

std::string SerialOutlet::status() const {
  const std::uint64_t lost = lost_ + (port_ ? port_->lost_sentences() : 0);
  return options_.device + ": " + (port_ ? "open" : "closed") + ", " + std::to_string(lost) +
         " sentences lost";
}

}  // namespace leonav
