// The NtripEndpoint is a stream of an NTRIP caster.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <optional>
#include <string>

#include "drivers/transport/credentials.h"
#include "drivers/transport/internal/endpoint.h"
#include "drivers/transport/internal/name_lookup.h"
#include "drivers/transport/internal/ntrip_session.h"
#include "drivers/transport/ntrip_source.h"

namespace leonav {

class NtripEndpoint final : public Endpoint {
 public:
  // Throws FileError where a file that the options name cannot be used.
  NtripEndpoint(boost::asio::io_context* io, const NtripOptions& options);
  ~NtripEndpoint() override { close(); }
  void open(Opened opened) override;
  void read(boost::asio::mutable_buffer buffer, Read done) override;
  void close() override;
  bool can_be_half_open() const override { return true; }
  RetryBounds retry_bounds() const override;
  std::string text_of(const boost::system::error_code& error) const override;

 private:
  std::string text_of_answer() const;

  boost::asio::io_context* io_;
  NtripOptions options_;
  NameLookup lookup_;
  std::optional<Credentials> credentials_;
  std::unique_ptr<boost::asio::ssl::context> tls_;
  std::shared_ptr<NtripSession> session_;  // the latest; also after close(), for text_of()
  NtripVersion asked_as_ = NtripVersion::k2;
};

// Whether a caster that was asked as version 2 may understand version 1 only: it has answered
// nothing, or that it does not understand.
bool may_be_version_1(const NtripReply& reply);

}  // namespace leonav
