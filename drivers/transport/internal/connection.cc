#include "drivers/transport/internal/connection.h"

#include <boost/asio/error.hpp>
#include <utility>

namespace leonav {

namespace asio = boost::asio;
using boost::system::error_code;

Connection::Connection(asio::io_context* io, const ArrivalClock* clock,
                       std::unique_ptr<Endpoint> endpoint)
    : clock_(clock), endpoint_(std::move(endpoint)), timer_(*io) {}

void Connection::start(ByteSink* sink) {
  sink_ = sink;
  open();
}

void Connection::reconnect(const std::string& why) {
  if (is_open_ && endpoint_->can_be_half_open()) fail(why);
}

void Connection::open() {
  const std::uint64_t attempt = ++attempt_;
  endpoint_->open([this, attempt](const error_code& error) {
    if (attempt == attempt_) on_opened(error);
  });
  const bool waits = endpoint_->waits_for_peer();
  timer_.expires_after(waits ? kTellWaiting : kOpenTimeout);
  timer_.async_wait([this, attempt, waits](const error_code& cancelled) {
    if (cancelled || attempt != attempt_ || is_open_) return;
    if (waits) return sink_->on_waiting(endpoint_->text_of(asio::error::timed_out));
    fail(endpoint_->text_of(asio::error::timed_out));
  });
}

void Connection::on_opened(const error_code& error) {
  if (error) return fail(endpoint_->text_of(error));
  timer_.cancel();
  is_open_ = true;
  opened_ = ArrivalClock::Steady::now();
  sink_->on_open();
  read();
}

void Connection::read() {
  endpoint_->read(asio::buffer(buffer_),
                  [this, attempt = attempt_](const error_code& error, std::size_t count) {
                    if (attempt == attempt_) on_read(error, count);
                  });
}

void Connection::on_read(const error_code& error, std::size_t count) {
  if (count > 0) {
    if (ArrivalClock::Steady::now() - opened_ > kWorksAfter) wait_.reset();
    const std::uint64_t attempt = attempt_;
    sink_->on_bytes({buffer_.data(), count}, clock_->now_ns());
    if (attempt != attempt_) return;  // the sink has asked for another connection
  }
  if (error == asio::error::eof && !endpoint_->can_reopen()) {
    endpoint_->close();
    is_open_ = false;
    has_ended_ = true;
    return sink_->on_end("");
  }
  if (error) return fail(endpoint_->text_of(error));
  read();
}

void Connection::fail(const std::string& why) {
  const std::uint64_t attempt = ++attempt_;
  is_open_ = false;
  endpoint_->close();
  if (has_ended_) return;
  if (!endpoint_->can_reopen()) {
    has_ended_ = true;
    return sink_->on_end(why);
  }
  const double wait_s = wait_.next_s(endpoint_->retry_bounds());
  sink_->on_failure(why, wait_s);
  timer_.expires_after(std::chrono::milliseconds(static_cast<long>(wait_s * 1e3)));
  timer_.async_wait([this, attempt](const error_code& cancelled) {
    if (!cancelled && attempt == attempt_) open();
  });
}

}  // namespace leonav
