#include "drivers/transport/internal/tls_context.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>

#include <boost/asio/error.hpp>

#include "drivers/text/parse.h"

namespace leonav {

namespace asio = boost::asio;
namespace ssl = boost::asio::ssl;
using boost::system::error_code;

std::unique_ptr<ssl::context> make_tls_context(const std::string& ca_file) {
  auto context = std::make_unique<ssl::context>(ssl::context::tls_client);
  context->set_options(ssl::context::default_workarounds | ssl::context::no_sslv2 |
                       ssl::context::no_sslv3 | ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1);
  context->set_verify_mode(ssl::verify_peer);
  error_code error;
  if (ca_file.empty()) {
    context->set_default_verify_paths(error);
    return context;
  }
  context->load_verify_file(ca_file, error);
  if (error) {
    throw FileError(ca_file, 0,
                    "no certificate can be read from it; name a readable file with the "
                    "certificate of the caster's authority in PEM");
  }
  return context;
}

bool expect_host(const std::string& host, TlsStream* stream) {
  SSL* connection = stream->native_handle();
  error_code no_address;
  asio::ip::make_address(host, no_address);
  if (!no_address) {
    return X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(connection), host.c_str()) == 1;
  }
  SSL_set_hostflags(connection, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  return SSL_set1_host(connection, host.c_str()) == 1 &&
         SSL_set_tlsext_host_name(connection, host.c_str()) == 1;
}

std::string handshake_problem(const std::string& host, TlsStream* stream, const error_code& error) {
  const long verified = SSL_get_verify_result(stream->native_handle());
  switch (verified) {
    case X509_V_OK:
      break;
    case X509_V_ERR_HOSTNAME_MISMATCH:
    case X509_V_ERR_IP_ADDRESS_MISMATCH:
      return "the caster's certificate is for another name than " + host +
             "; give the name of the certificate as 'host'";
    case X509_V_ERR_CERT_HAS_EXPIRED:
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return std::string("the caster's certificate cannot be trusted (") +
             X509_verify_cert_error_string(verified) + "); is this machine's clock right?";
    default:
      return std::string("the caster's certificate cannot be trusted (") +
             X509_verify_cert_error_string(verified) +
             "); name the certificate of its authority as 'ca_file', or install ca-certificates";
  }
  if (error == asio::error::eof || error == ssl::error::stream_truncated ||
      error == asio::error::connection_reset) {
    return "the connection was closed before it was encrypted; is TLS spoken at this port?";
  }
  if (error.category() == asio::error::get_ssl_category() &&
      ERR_GET_REASON(static_cast<unsigned long>(error.value())) == SSL_R_WRONG_VERSION_NUMBER) {
    return "what listens there does not speak TLS; use the caster's port for TLS, or 'tls: false'";
  }
  return "no encrypted connection: " + error.message();
}

}  // namespace leonav
