// This unit prepares encrypted connections: which certificates are trusted, and what is wrong with
// one that is not.
#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <memory>
#include <string>

namespace leonav {

using TlsStream = boost::asio::ssl::stream<boost::asio::ip::tcp::socket&>;

// TLS 1.2 or later with a peer whose certificate verifies against those in `ca_file` (PEM), or the
// system's where it is empty. Throws FileError where the file cannot be used.
std::unique_ptr<boost::asio::ssl::context> make_tls_context(const std::string& ca_file);

// The peer's certificate must be for `host`, a name or an address. Returns false where OpenSSL
// refuses that.
bool expect_host(const std::string& host, TlsStream* stream);

// What failed in a handshake, with the remedy.
std::string handshake_problem(const std::string& host, TlsStream* stream,
                              const boost::system::error_code& error);

}  // namespace leonav
