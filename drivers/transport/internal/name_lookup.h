// A NameLookup finds the addresses of one host, for one stream.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace leonav {

// An address is its own answer. A name is asked for in a thread of its own: the system's query
// cannot be cancelled and lasts for seconds where the name server is mute, which must hold up
// neither another stream nor the end of the program. While a query runs no second one begins: who
// asks again gets the answer of the first.
class NameLookup {
 public:
  using Error = boost::system::error_code;
  using Results = boost::asio::ip::tcp::resolver::results_type;
  using Found = std::function<void(const Error&, const Results&)>;

  // A query of host and port, which may last; the system's unless a test gives another.
  using Query = std::function<Results(const std::string&, const std::string&, Error*)>;

  NameLookup(boost::asio::io_context* io, const std::string& host, std::uint16_t port,
             Query query = ask_system);
  ~NameLookup();
  NameLookup(const NameLookup&) = delete;
  NameLookup& operator=(const NameLookup&) = delete;

  // Calls back from the io_context, never before it returns, and not after cancel(). After another
  // start() the last one alone is called back, once, by the first answer that comes.
  void start(Found found);
  void cancel();
  // Whether the name server has been asked and has not answered yet.
  bool is_asking() const;

 private:
  struct State;
  static Results ask_system(const std::string& host, const std::string& port, Error* error);
  void answer(const Error& error, const Results& results);
  void ask();

  boost::asio::io_context* io_;
  std::string host_;
  std::uint16_t port_;
  Query query_;
  std::shared_ptr<State> state_;  // shared with the thread, which may outlive this object
};

}  // namespace leonav
