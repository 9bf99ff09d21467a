#include "tools/connect/connector.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/link/lcm_publisher.h"
#include "daemon/link/service_manager.h"
#include "drivers/transport/file_source.h"
#include "drivers/transport/live_sources.h"
#include "drivers/transport/ntrip_source.h"
#include "drivers/transport/recording.h"
#include "tools/connect/formats/inertial/imu_line_format.h"
#include "tools/connect/formats/inertial/vectornav_format.h"
#include "tools/connect/formats/inertial/xsens_format.h"
#include "tools/connect/formats/outputs/message_output.h"
#include "tools/connect/formats/outputs/product_output.h"
#include "tools/connect/formats/outputs/product_watch.h"
#include "tools/connect/formats/pages/page_format.h"
#include "tools/connect/formats/receivers/oem7_format.h"
#include "tools/connect/formats/receivers/rtcm3_format.h"
#include "tools/connect/formats/receivers/sbf_format.h"
#include "tools/connect/formats/receivers/ubx_format.h"
#include "tools/connect/stream.h"
#include "tools/connect/stream_status.h"

namespace leonav {

namespace asio = boost::asio;

namespace {

void tell_change(const ServiceChange& change) {
  const bool is_fallback = !change.from.empty() && !change.is_return;
  spdlog::log(is_fallback ? spdlog::level::warn : spdlog::level::info, "{}", to_text(change));
}

// What is played does not depend on the host that plays it.
std::function<bool()> host_question(const ConnectConfig& config) {
  if (has_only_files(config)) return {};
  return [] { return HostClock::is_unsynchronised(); };
}

// A time of the clock that the arrivals are of. That of recordings has counted the leap seconds of
// their day.
std::int64_t arrivals_begin_ns(const ConnectConfig& config, std::int64_t now_ns) {
  if (!has_only_files(config)) return now_ns;
  std::optional<std::int64_t> first_ns;
  for (const StreamConfig& stream : config.streams) {
    const auto* file = std::get_if<FileOptions>(&stream.source);
    const auto arrival_ns = file != nullptr ? first_arrival_ns(file->path) : std::nullopt;
    if (arrival_ns) first_ns = std::min(first_ns.value_or(*arrival_ns), *arrival_ns);
  }
  return first_ns.value_or(now_ns);
}

}  // namespace

struct Connector::State {
  explicit State(const ConnectConfig& configuration)
      : config(configuration),
        publisher(config.lcm),
        output(&publisher),
        products(config.products, product_repeat_s(config), &output),
        corrections(config.corrections, config.services, &output, tell_change),
        gps(config.reference, config.gnss_latency_s, arrivals_begin_ns(config, clock.now_ns()),
            host_question(config)),
        clocks(config.playback_speed, &clock),
        signals(io, SIGTERM, SIGINT),
        second(io) {
    output.expect_orbits(config.expected_orbits);
    output.listen_to_time([this](GpsTime time) { products.send_due(time); });
    corrections.on_biases = [this](std::span<const SignalBias> biases) {
      products.yield_to(biases);
    };
    for (const StreamConfig& stream : config.streams) {
      correction_outputs.try_emplace(stream.name, stream.name, &corrections);
      streams.push_back(
          std::make_unique<Stream>(stream, &clock, make_source(stream), make_format(stream)));
    }
  }

  std::unique_ptr<ByteSource> make_source(const StreamConfig& stream);
  std::unique_ptr<StreamFormat> make_format(const StreamConfig& stream);
  std::unique_ptr<StreamFormat> make_ubx_format(const StreamConfig& stream);
  CorrectionOutput* corrections_of(const StreamConfig& stream) {
    return &correction_outputs.at(stream.name);
  }
  void wait_for_signal();
  void wait_a_second();
  void each_second();
  std::optional<double> compare_clocks();
  void watch_host();
  void tell_products();
  void publish_status();
  bool all_have_ended() const {
    return std::all_of(streams.begin(), streams.end(),
                       [](const auto& stream) { return stream->has_ended(); });
  }

  ConnectConfig config;
  LcmPublisher publisher;
  MessageOutput output;
  ProductOutput products;
  ProductWatch product_watch;
  SharedCorrections corrections;
  // One of each stream, also of those without corrections: their ephemerides are corrected.
  std::map<std::string, CorrectionOutput> correction_outputs;
  ArrivalClock clock;
  GpsClock gps;
  PulseQueue pulses;
  PlaybackClocks clocks;
  asio::io_context io;  // before all that uses it
  asio::signal_set signals;
  asio::steady_timer second;
  std::vector<std::unique_ptr<Stream>> streams;
  ServiceManager manager;
  std::uint64_t seconds = 0;
  bool host_was_wrong = false;  // by the receiver's epochs
  bool was_stopped = false;
};

std::unique_ptr<ByteSource> Connector::State::make_source(const StreamConfig& stream) {
  if (const auto* serial = std::get_if<SerialOptions>(&stream.source)) {
    return make_serial_source(&io, &clock, *serial);
  }
  if (const auto* tcp = std::get_if<TcpOptions>(&stream.source)) {
    return make_tcp_source(&io, &clock, *tcp);
  }
  if (const auto* ntrip = std::get_if<NtripOptions>(&stream.source)) {
    return make_ntrip_source(&io, &clock, *ntrip);
  }
  if (const auto* server = std::get_if<TcpServerOptions>(&stream.source)) {
    return make_tcp_server_source(&io, &clock, server->listen);
  }
  if (const auto* udp = std::get_if<UdpOptions>(&stream.source)) {
    return make_udp_source(&io, &clock, udp->listen);
  }
  if (const auto* file = std::get_if<FileOptions>(&stream.source)) {
    return make_file_source(&io, &clocks, file->path);
  }
  return make_input_source(&io, &clock);
}

std::unique_ptr<StreamFormat> Connector::State::make_ubx_format(const StreamConfig& stream) {
  const UbxStreamOptions options{stream.is_inertial, stream.stamps, config.pulse.input,
                                 stream.uses_pages};
  return std::make_unique<UbxFormat>(config.gnss_latency_s, stream.repeat_s, &gps, &output,
                                     corrections_of(stream), options,
                                     config.pulse.stream.empty() ? nullptr : &pulses);
}

std::unique_ptr<StreamFormat> Connector::State::make_format(const StreamConfig& stream) {
  PulseQueue* own_pulses = stream.name == config.pulse.stream ? &pulses : nullptr;
  switch (stream.format) {
    case FormatKind::kUbx:
      return make_ubx_format(stream);
    case FormatKind::kRtcm3:
      return std::make_unique<Rtcm3Format>(stream.day, stream.repeat_s, &gps, &output,
                                           stream.is_service, corrections_of(stream));
    case FormatKind::kOem7:
      return std::make_unique<Oem7Format>(Oem7StreamOptions{stream.is_inertial, stream.imu_scale},
                                          config.gnss_latency_s, stream.repeat_s, &gps, &output,
                                          corrections_of(stream));
    case FormatKind::kSbf:
      return std::make_unique<SbfFormat>(SbfStreamOptions{stream.is_inertial, stream.uses_pages},
                                         config.gnss_latency_s, stream.repeat_s, &gps, &output,
                                         corrections_of(stream));
    case FormatKind::kVectornav:
      return std::make_unique<VectornavFormat>(&gps, stream.stamps, &output, own_pulses);
    case FormatKind::kXsens:
      return std::make_unique<XsensFormat>(&gps, stream.stamps, &output, own_pulses);
    case FormatKind::kHas:
      return std::make_unique<PageFormat>(PageService::kGalileoHas, corrections_of(stream));
    case FormatKind::kB2b:
      return std::make_unique<PageFormat>(PageService::kBeidouB2b, corrections_of(stream));
    case FormatKind::kImuLine:
      break;
  }
  return std::make_unique<ImuLineFormat>(stream.line, &gps, stream.stamps, &output, own_pulses);
}

// The second signal ends the process at once.
void Connector::State::wait_for_signal() {
  signals.async_wait([this](const boost::system::error_code& error, int signal) {
    if (error) return;
    spdlog::info("{}: finishing", signal == SIGTERM ? "SIGTERM" : "SIGINT");
    signals.clear();
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
    was_stopped = true;
    io.stop();
  });
}

void Connector::State::wait_a_second() {
  second.expires_after(std::chrono::seconds(1));
  second.async_wait([this](const boost::system::error_code& error) {
    if (error) return;
    each_second();
    if (all_have_ended()) return io.stop();
    wait_a_second();
  });
}

void Connector::State::each_second() {
  ++seconds;
  for (const auto& stream : streams) stream->look();
  watch_host();
  tell_products();
  publish_status();
  manager.feed_watchdog();  // the one thread that reads all streams is alive
  const auto interval = static_cast<std::uint64_t>(config.status_interval_s);
  if (interval == 0 || seconds % interval != 0) return;
  for (const auto& stream : streams) spdlog::info("{}", status_text(*stream, clock.now_ns()));
}

std::optional<double> Connector::State::compare_clocks() {
  const std::int64_t now_ns = clock.now_ns();
  return gps.compare_host(now_ns + clock.wall_lead_ns(), now_ns);
}

void Connector::State::watch_host() {
  const std::optional<double> step_s = has_only_files(config) ? std::nullopt : compare_clocks();
  if (config.reference != TimeReference::kHost) return;
  if (step_s) {
    spdlog::warn("the host's clock was set by {:+.3f} s; stamps follow it from now on", *step_s);
  }
  gps.look_at_epochs();
  const std::optional<double> error_s = gps.host_error_s();
  if (error_s.has_value() == std::exchange(host_was_wrong, error_s.has_value())) return;
  if (error_s) {
    spdlog::warn(
        "the host's clock is {:+.1f} s against the receiver's epochs, and 'time.reference: host' "
        "stamps by it: what keeps it at UTC (chronyc tracking, pmc), and is the receiver's time "
        "known?",
        *error_s);
  } else {
    spdlog::info("the host's clock agrees with the receiver's epochs");
  }
}

void Connector::State::tell_products() {
  if (!products.time().is_set()) return;
  for (const auto& [is_warning, text] : product_watch.look(products.holding(), products.time())) {
    spdlog::log(is_warning ? spdlog::level::warn : spdlog::level::info, "{}", text);
  }
}

void Connector::State::publish_status() {
  const streams_t message = streams_message(streams, output.last_time(), seconds, clock.now_ns());
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  publisher.publish(kStreamsChannel, bytes);
}

Connector::Connector(const ConnectConfig& config) : state_(std::make_unique<State>(config)) {}
Connector::~Connector() = default;

ConnectorEnd Connector::run() {
  State& s = *state_;
  std::signal(SIGPIPE, SIG_IGN);
  if (!s.manager.problem().empty()) spdlog::warn("{}", s.manager.problem());
  s.wait_for_signal();
  for (const auto& stream : s.streams) stream->start();
  s.wait_a_second();
  spdlog::info("running; LCM {}, channels {}*, {} streams", s.config.lcm.url, s.config.lcm.prefix,
               s.streams.size());
  s.manager.ready();
  s.io.run();
  s.manager.stopping();
  for (const auto& stream : s.streams) stream->end_recording();
  bool failed = s.output.sent() == 0;
  for (const auto& stream : s.streams) {
    stream->finish();
    failed = failed || stream->watch().failures() > 0;
    spdlog::info("{}", status_text(*stream, s.clock.now_ns()));
  }
  s.publish_status();
  if (s.was_stopped) return ConnectorEnd::kStopped;
  return failed ? ConnectorEnd::kFailed : ConnectorEnd::kDone;
}

}  // namespace leonav
