#include "tools/serve/tcp_outlet.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <stdexcept>
#include <utility>
#include <vector>

namespace leonav {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

std::string text_of(const tcp::endpoint& endpoint) {
  const std::string address = endpoint.address().to_string();
  const std::string port = ":" + std::to_string(endpoint.port());
  return (endpoint.address().is_v6() ? "[" + address + "]" : address) + port;
}

}  // namespace

TcpOutlet::TcpOutlet(asio::io_context* io, const ListenOptions& options)
    : acceptor_(*io), pause_(*io) {
  const tcp::endpoint endpoint(asio::ip::make_address(options.address), options.port);
  name_ = "TCP " + text_of(endpoint);
  error_code error;
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
  if (error) {
    throw std::runtime_error(name_ + " cannot be served (" + error.message() +
                             "); is another program on this port (ss -ltnp), and is tcp.address "
                             "one of this host's?");
  }
  accept();
}

void TcpOutlet::accept() {
  acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      add(std::move(socket));
      return accept();
    }
    spdlog::warn("{}: a client could not be taken: {}", name_, error.message());
    pause_.expires_after(std::chrono::seconds(1));
    pause_.async_wait([this](const error_code& cancelled) {
      if (!cancelled) accept();
    });
  });
}

void TcpOutlet::add(tcp::socket socket) {
  error_code error;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  if (error) return;  // has gone already
  // What waits in the kernel is as old as what waits here: let it be little.
  socket.set_option(asio::socket_base::send_buffer_size(16'384), error);
  socket.set_option(tcp::no_delay(true), error);
  socket.set_option(asio::socket_base::keep_alive(true), error);
  const std::string name = name_ + ", client " + text_of(peer);
  const auto client = std::make_shared<Client>(std::move(socket), name);
  clients_.insert(client);
  client->start([this, weak = std::weak_ptr<Client>(client)](const error_code& reason) {
    const auto gone = weak.lock();
    if (!gone) return;
    lost_ += gone->lost_sentences();
    spdlog::info("{}: gone ({})", gone->name(), reason.message());
    clients_.erase(gone);
  });
  spdlog::info("{}: connected", name);
}

void TcpOutlet::send(const std::shared_ptr<const Batch>& batch) {
  // A client that fails leaves the set later, by its own completion.
  for (const auto& client : clients_) client->send(batch);
}

std::string TcpOutlet::status() const {
  std::uint64_t lost = lost_;
  for (const auto& client : clients_) lost += client->lost_sentences();
  return name_ + ": " + std::to_string(clients_.size()) + " clients, " + std::to_string(lost) +
         " sentences lost";
}

}  // namespace leonav
