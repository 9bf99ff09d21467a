// An NtripSession is one connection to a caster, from the look-up of its name to its close.
#pragma once
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/internal/endpoint.h"
#include "drivers/transport/internal/name_lookup.h"
#include "drivers/transport/internal/ntrip_reply.h"
#include "drivers/transport/internal/tls_context.h"
#include "drivers/transport/ntrip_source.h"

namespace leonav {

// It is held by what it has asked of the io_context, so that nothing of one connection can reach
// the next one.
class NtripSession : public std::enable_shared_from_this<NtripSession> {
 public:
  // `tls` is null for a connection that is not encrypted; `options`, `lookup` and `tls` must
  // outlive the call of close().
  NtripSession(boost::asio::io_context* io, const NtripOptions* options, NameLookup* lookup,
               boost::asio::ssl::context* tls, std::string request);

  // As those of Endpoint; an error of protocol means that answer() or tls_problem() says more.
  void open(Endpoint::Opened opened);
  void read(boost::asio::mutable_buffer buffer, Endpoint::Read done);
  void close();

  const NtripReply& reply() const { return reply_; }
  // Why there is no encrypted connection; empty: there is, or it has not come to that.
  const std::string& tls_problem() const { return tls_problem_; }
  bool is_connected() const { return is_connected_; }
  bool has_asked() const { return has_asked_; }

 private:
  using Error = boost::system::error_code;
  void connect(const NameLookup::Results& found);
  void shake_hands();
  void ask();
  void await_answer();
  void on_answer(const Error& error, std::size_t count);
  void finish_open(const Error& error);
  bool deliver(boost::asio::mutable_buffer buffer, Endpoint::Read* done);
  void on_bytes(boost::asio::mutable_buffer buffer, Endpoint::Read done, const Error& error,
                std::size_t count);
  void send_position();
  void wait_to_send();
  template <typename Handler>
  void read_some(Handler handler);
  template <typename Handler>
  void write_all(Handler handler);

  const NtripOptions* options_;
  NameLookup* lookup_;
  boost::asio::ip::tcp::socket socket_;
  std::optional<TlsStream> tls_;
  boost::asio::steady_timer timer_;  // of the position
  std::string outgoing_;             // the request, then a line with the position
  Endpoint::Opened opened_;
  NtripReply reply_;
  std::string tls_problem_;
  bool is_closed_ = false, is_connected_ = false, has_asked_ = false;
  std::array<std::uint8_t, 4096> incoming_;
  std::vector<std::uint8_t> stream_;  // bytes that nobody has read yet
  std::size_t delivered_ = 0;         // of them
};

}  // namespace leonav
