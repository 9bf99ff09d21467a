#include "drivers/transport/internal/ntrip_endpoint.h"

#include <boost/asio/error.hpp>
#include <utility>

#include "drivers/transport/internal/network_text.h"
#include "drivers/transport/internal/ntrip_request.h"

namespace leonav {

namespace asio = boost::asio;
using boost::system::error_code;

bool may_be_version_1(const NtripReply& reply) {
  constexpr int kBadRequest = 400, kNotImplemented = 501, kNoSuchVersion = 505;
  switch (reply.answer()) {
    case NtripAnswer::kPending:
    case NtripAnswer::kNotNtrip:
      return true;
    case NtripAnswer::kStatus:
      return reply.status() == kBadRequest || reply.status() == kNotImplemented ||
             reply.status() == kNoSuchVersion;
    default:
      return false;
  }
}

NtripEndpoint::NtripEndpoint(asio::io_context* io, const NtripOptions& options)
    : io_(io), options_(options), lookup_(io, options.host, options.port) {
  if (!options_.credentials_file.empty()) {
    credentials_ = read_credentials(options_.credentials_file);
  }
  if (options_.tls) tls_ = make_tls_context(options_.ca_file);
  if (options_.version == NtripVersion::k1) asked_as_ = NtripVersion::k1;
}

void NtripEndpoint::open(Opened opened) {
  if (options_.version == NtripVersion::kAuto && session_ != nullptr && session_->has_asked()) {
    if (asked_as_ == NtripVersion::k1 && session_->reply().answer() != NtripAnswer::kStream) {
      asked_as_ = NtripVersion::k2;
    } else if (asked_as_ == NtripVersion::k2 && may_be_version_1(session_->reply())) {
      asked_as_ = NtripVersion::k1;
    }
  }
  std::string position = options_.position_line ? options_.position_line() : "";
  while (position.ends_with('\n') || position.ends_with('\r')) position.pop_back();
  session_ =
      std::make_shared<NtripSession>(io_, &options_, &lookup_, tls_.get(),
                                     ntrip_request(options_, asked_as_, credentials_, position));
  session_->open(std::move(opened));
}

void NtripEndpoint::read(asio::mutable_buffer buffer, Read done) {
  session_->read(buffer, std::move(done));
}

void NtripEndpoint::close() {
  if (session_ != nullptr) session_->close();
}

// A caster that refuses will do so again, and may lock out who asks too often.
RetryBounds NtripEndpoint::retry_bounds() const {
  if (session_ == nullptr) return {};
  switch (session_->reply().answer()) {
    case NtripAnswer::kPassword:
    case NtripAnswer::kMountpoint:
    case NtripAnswer::kNoStream:
      return {.least_s = RetryWait::kLongest_s, .most_s = RetryWait::kLongest_s};
    default:
      return {};
  }
}

std::string NtripEndpoint::text_of(const error_code& error) const {
  const std::string what = options_.host + ":" + std::to_string(options_.port) + ": ";
  if (session_ == nullptr) return what + network_text(error);
  if (!session_->tls_problem().empty()) return what + session_->tls_problem();
  if (error == boost::system::errc::protocol_error) return what + text_of_answer();
  if (error == asio::error::timed_out && lookup_.is_asking()) return what + mute_name_server_text();
  if (error == asio::error::timed_out && session_->is_connected()) {
    return what + (session_->has_asked()
                       ? "the caster takes the request and does not answer it; is this the port "
                         "of the caster, and is 'tls' right?"
                       : "the connection stands, but it cannot be encrypted; is TLS spoken at "
                         "this port?");
  }
  if (error == asio::error::eof && session_->reply().answer() == NtripAnswer::kPending) {
    return what +
           "the caster closed the connection without an answer; are 'version' and 'tls' "
           "right?";
  }
  return what + network_text(error);
}

// Nothing that the caster has written is quoted: it could have in it what it was sent.
std::string NtripEndpoint::text_of_answer() const {
  const NtripReply& reply = session_->reply();
  switch (reply.answer()) {
    case NtripAnswer::kPassword:
      return std::string("the caster refuses ") +
             (credentials_ ? "the user or the password"
                           : "to give the stream without user and password") +
             (reply.status() != 0 ? " (" + std::to_string(reply.status()) + ")" : "") +
             "; correct 'credentials_file', and start again";
    case NtripAnswer::kMountpoint:
      return "the caster has no mountpoint " + options_.mountpoint +
             "; its source table lists those that it has";
    case NtripAnswer::kNoStream:
      return "a page of text comes, no stream; is 'port' that of the caster?";
    case NtripAnswer::kStatus:
      return "the caster answers with status " + std::to_string(reply.status()) +
             " of HTTP; ask its operator if it lasts";
    case NtripAnswer::kEncrypted:
      return "TLS is spoken at this port; set 'tls: true'";
    case NtripAnswer::kBrokenChunk:
      return "the stream breaks the rules of HTTP's chunks; a proxy may have damaged it";
    default:
      return "what listens there gives no answer of NTRIP; check 'host' and 'port'";
  }
}

}  // namespace leonav
