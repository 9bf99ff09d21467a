// The TcpOutlet serves any number of TCP clients.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <set>

#include "tools/serve/outlet.h"
#include "tools/serve/serve_config.h"
#include "tools/serve/stream_writer.h"

namespace leonav {

class TcpOutlet final : public Outlet {
 public:
  // Throws std::runtime_error where the port cannot be had.
  TcpOutlet(boost::asio::io_context* io, const ListenOptions& options);

  void send(const std::shared_ptr<const Batch>& batch) override;
  std::string status() const override;

 private:
  using Client = StreamWriter<boost::asio::ip::tcp::socket>;
  void accept();
  void add(boost::asio::ip::tcp::socket socket);

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;  // after a client that could not be taken
  std::string name_;
  std::set<std::shared_ptr<Client>> clients_;
  std::uint64_t lost_ = 0;  // by clients that have gone
};

}  // namespace leonav
