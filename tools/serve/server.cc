#include "tools/serve/server.h"

#include <spdlog/spdlog.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <vector>

#include "daemon/link/open_lcm.h"
#include "daemon/link/service_manager.h"
#include "drivers/lcm/channels.h"
#include "tools/serve/pty_outlet.h"
#include "tools/serve/sentence_feed.h"
#include "tools/serve/serial_outlet.h"
#include "tools/serve/tcp_outlet.h"
#include "tools/serve/udp_outlet.h"

namespace leonav {

namespace asio = boost::asio;
using boost::system::error_code;

struct Server::State {
  explicit State(const ServeConfig& configuration)
      : config(configuration),
        feed(config),
        lcm(open_lcm(config.lcm.url)),
        messages(io),
        signals(io, SIGTERM, SIGINT),
        second(io) {
    subscribe(Channel::kSolution, &State::on_solution);
    subscribe(Channel::kEpoch, &State::on_epoch);
    messages.assign(lcm->getFileno());
    if (config.tcp.port != 0) outlets.push_back(std::make_unique<TcpOutlet>(&io, config.tcp));
    if (config.udp.port != 0) outlets.push_back(std::make_unique<UdpOutlet>(&io, config.udp));
    if (!config.serial.device.empty()) {
      outlets.push_back(std::make_unique<SerialOutlet>(&io, config.serial));
    }
    if (!config.pty_link.empty()) {
      outlets.push_back(std::make_unique<PtyOutlet>(&io, config.pty_link));
    }
  }
  ~State() { messages.release(); }  // the descriptor is LCM's

  using Handler = void (State::*)(const lcm::ReceiveBuffer*, const std::string&);
  void subscribe(Channel channel, Handler handler);
  void on_solution(const lcm::ReceiveBuffer* buffer, const std::string&);
  void on_epoch(const lcm::ReceiveBuffer* buffer, const std::string&);
  void wait_for_messages();
  void wait_for_signal();
  void wait_a_second();
  void each_second();
  void log_status() const;

  ServeConfig config;
  SentenceFeed feed;
  std::unique_ptr<lcm::LCM> lcm;
  asio::io_context io;  // before all that uses it
  asio::posix::stream_descriptor messages;
  asio::signal_set signals;
  asio::steady_timer second;
  std::vector<std::unique_ptr<Outlet>> outlets;
  ServiceManager manager;
  std::uint64_t seconds = 0, batches = 0, silent_s = 0;
  std::uint64_t seen_solutions = 0, told_refused = 0;
  bool has_failed = false;
};

void Server::State::subscribe(Channel channel, Handler handler) {
  const std::string name = channel_name(channel, config.lcm.prefix);
  lcm::Subscription* subscription = lcm->subscribe(name, handler, this);
  if (subscription == nullptr) {
    throw LcmError("LCM cannot subscribe to " + name + " at '" + config.lcm.url + "'");
  }
  subscription->setQueueCapacity(config.lcm.receive_queue);
}

void Server::State::on_solution(const lcm::ReceiveBuffer* buffer, const std::string&) {
  const auto batch =
      feed.on_solution({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  if (!batch) return;
  ++batches;
  for (const auto& outlet : outlets) outlet->send(batch);
}

void Server::State::on_epoch(const lcm::ReceiveBuffer* buffer, const std::string&) {
  feed.on_epoch({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
}

void Server::State::wait_for_messages() {
  messages.async_wait(asio::posix::stream_descriptor::wait_read, [this](const error_code& error) {
    if (error == asio::error::operation_aborted) return;
    if (error || lcm->handleTimeout(0) < 0) {
      spdlog::error("LCM at '{}' has failed", config.lcm.url);
      has_failed = true;
      return io.stop();
    }
    wait_for_messages();
  });
}

// The second signal ends the process at once.
void Server::State::wait_for_signal() {
  signals.async_wait([this](const error_code& error, int signal) {
    if (error) return;
    spdlog::info("{}: finishing", signal == SIGTERM ? "SIGTERM" : "SIGINT");
    signals.clear();
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
    io.stop();
  });
}

void Server::State::wait_a_second() {
  second.expires_after(std::chrono::seconds(1));
  second.async_wait([this](const error_code& error) {
    if (error) return;
    each_second();
    wait_a_second();
  });
}

void Server::State::each_second() {
  constexpr std::uint64_t kSilent_s = 5;
  ++seconds;
  manager.feed_watchdog();  // the one thread that writes to all outlets is alive
  const bool is_silent = feed.solutions() == seen_solutions;
  if (!is_silent && silent_s >= kSilent_s) spdlog::info("SOLUTION comes again");
  silent_s = is_silent ? silent_s + 1 : 0;
  seen_solutions = feed.solutions();
  if (silent_s == kSilent_s) {
    spdlog::warn(
        "no {} for {} s: nothing is written; does leonavd run, with this lcm.url and lcm.prefix?",
        channel_name(Channel::kSolution, config.lcm.prefix), kSilent_s);
  }
  if (feed.refused() > 0 && told_refused == 0) {
    spdlog::warn("a message could not be read; are leonavd and leonav-serve of one version?");
  }
  told_refused = feed.refused();
  const auto interval = static_cast<std::uint64_t>(config.status_interval_s);
  if (interval != 0 && seconds % interval == 0) log_status();
}

void Server::State::log_status() const {
  spdlog::info("{} solutions, the last one '{}'; {} instants written, {} messages refused",
               feed.solutions(), to_string(feed.last().source), batches, feed.refused());
  for (const auto& outlet : outlets) spdlog::info("{}", outlet->status());
}

Server::Server(const ServeConfig& config) : state_(std::make_unique<State>(config)) {}
Server::~Server() = default;

bool Server::run() {
  State& s = *state_;
  std::signal(SIGPIPE, SIG_IGN);
  if (!s.manager.problem().empty()) spdlog::warn("{}", s.manager.problem());
  s.wait_for_signal();
  s.wait_for_messages();
  s.wait_a_second();
  spdlog::info("running at {} Hz; LCM {}, channels {}*; heights are above {}", s.config.rate_hz,
               s.config.lcm.url, s.config.lcm.prefix,
               s.config.fix.geoid_separation_m == 0.0 ? "the ellipsoid: geoid_separation_m is 0"
                                                      : "the geoid by geoid_separation_m");
  s.manager.ready();
  s.io.run();
  s.manager.stopping();
  s.log_status();
  return !s.has_failed;
}

}  // namespace leonav
