#include "drivers/transport/internal/ntrip_session.h"

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <cstring>
#include <utility>

namespace leonav {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

boost::system::error_code protocol_error() {
  return boost::system::errc::make_error_code(boost::system::errc::protocol_error);
}

// Casters close without TLS's goodbye: that is an end like any other.
boost::system::error_code as_end(const boost::system::error_code& error) {
  return error == asio::ssl::error::stream_truncated ? asio::error::eof : error;
}

}  // namespace

NtripSession::NtripSession(asio::io_context* io, const NtripOptions* options, NameLookup* lookup,
                           asio::ssl::context* tls, std::string request)
    : options_(options), lookup_(lookup), socket_(*io), timer_(*io), outgoing_(std::move(request)) {
  if (tls != nullptr) tls_.emplace(socket_, *tls);
}

template <typename Handler>
void NtripSession::read_some(Handler handler) {
  if (tls_) return tls_->async_read_some(asio::buffer(incoming_), std::move(handler));
  socket_.async_read_some(asio::buffer(incoming_), std::move(handler));
}

template <typename Handler>
void NtripSession::write_all(Handler handler) {
  if (tls_) return asio::async_write(*tls_, asio::buffer(outgoing_), std::move(handler));
  asio::async_write(socket_, asio::buffer(outgoing_), std::move(handler));
}

void NtripSession::open(Endpoint::Opened opened) {
  opened_ = std::move(opened);
  lookup_->start([self = shared_from_this()](const Error& error, const NameLookup::Results& found) {
    if (self->is_closed_) return;
    if (error) return self->finish_open(error);
    self->connect(found);
  });
}

void NtripSession::connect(const NameLookup::Results& found) {
  asio::async_connect(socket_, found,
                      [self = shared_from_this()](const Error& error, const tcp::endpoint&) {
                        if (self->is_closed_) return;
                        if (error) return self->finish_open(error);
                        self->is_connected_ = true;
                        Error ignored;
                        self->socket_.set_option(asio::socket_base::keep_alive(true), ignored);
                        self->tls_ ? self->shake_hands() : self->ask();
                      });
}

void NtripSession::shake_hands() {
  if (!expect_host(options_->host, &*tls_)) {
    tls_problem_ = "'host' is no name that a certificate can have";
    return finish_open(protocol_error());
  }
  tls_->async_handshake(
      asio::ssl::stream_base::client, [self = shared_from_this()](const Error& error) {
        if (self->is_closed_) return;
        if (!error) return self->ask();
        self->tls_problem_ = handshake_problem(self->options_->host, &*self->tls_, error);
        self->finish_open(protocol_error());
      });
}

void NtripSession::ask() {
  write_all([self = shared_from_this()](const Error& error, std::size_t) {
    self->outgoing_.clear();
    if (self->is_closed_) return;
    if (error) return self->finish_open(error);
    self->has_asked_ = true;
    self->await_answer();
  });
}

void NtripSession::await_answer() {
  read_some([self = shared_from_this()](const Error& error, std::size_t count) {
    if (!self->is_closed_) self->on_answer(error, count);
  });
}

void NtripSession::on_answer(const Error& error, std::size_t count) {
  const NtripAnswer answer = reply_.feed({incoming_.data(), count}, &stream_);
  if (answer == NtripAnswer::kStream || answer == NtripAnswer::kEnded) {
    finish_open({});
    return send_position();
  }
  if (answer != NtripAnswer::kPending) return finish_open(protocol_error());
  if (error) return finish_open(as_end(error));
  await_answer();
}

void NtripSession::finish_open(const Error& error) {
  const Endpoint::Opened opened = std::exchange(opened_, nullptr);
  if (opened) opened(error);
}

// Calls `done` back with what is there: bytes first, then the end of the stream.
bool NtripSession::deliver(asio::mutable_buffer buffer, Endpoint::Read* done) {
  const std::size_t count = std::min(buffer.size(), stream_.size() - delivered_);
  const NtripAnswer answer = reply_.answer();
  if (count == 0 && answer == NtripAnswer::kStream) return false;
  Error error;
  if (count == 0) error = answer == NtripAnswer::kEnded ? asio::error::eof : protocol_error();
  if (count > 0) std::memcpy(buffer.data(), stream_.data() + delivered_, count);
  delivered_ += count;
  if (delivered_ == stream_.size()) {
    stream_.clear();
    delivered_ = 0;
  }
  (*done)(error, count);
  return true;
}

void NtripSession::read(asio::mutable_buffer buffer, Endpoint::Read done) {
  if (!stream_.empty() || reply_.answer() != NtripAnswer::kStream) {
    asio::post(socket_.get_executor(),
               [self = shared_from_this(), buffer, done = std::move(done)]() mutable {
                 if (!self->is_closed_) self->deliver(buffer, &done);
               });
    return;
  }
  read_some([self = shared_from_this(), buffer, done = std::move(done)](const Error& error,
                                                                        std::size_t count) mutable {
    if (!self->is_closed_) self->on_bytes(buffer, std::move(done), error, count);
  });
}

void NtripSession::on_bytes(asio::mutable_buffer buffer, Endpoint::Read done, const Error& error,
                            std::size_t count) {
  reply_.feed({incoming_.data(), count}, &stream_);
  if (deliver(buffer, &done)) return;
  if (!error) return read(buffer, std::move(done));
  done(as_end(error), 0);
}

// A line is written only when the one before it has gone out.
void NtripSession::send_position() {
  if (is_closed_ || !options_->position_line) return;
  outgoing_ = options_->position_line();
  if (outgoing_.empty()) return;
  write_all([self = shared_from_this()](const Error& error, std::size_t) {
    // A connection that takes nothing more shows where it is read.
    if (!error && !self->is_closed_) self->wait_to_send();
  });
}

void NtripSession::wait_to_send() {
  if (options_->position_interval_s <= 0.0) return;
  timer_.expires_after(
      std::chrono::milliseconds(static_cast<long>(options_->position_interval_s * 1e3)));
  timer_.async_wait([self = shared_from_this()](const Error& cancelled) {
    if (!cancelled && !self->is_closed_) self->send_position();
  });
}

void NtripSession::close() {
  opened_ = nullptr;
  Error ignored;
  if (!std::exchange(is_closed_, true)) lookup_->cancel();
  timer_.cancel();
  socket_.close(ignored);
}

}  // namespace leonav
