#include "drivers/transport/file_source.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "drivers/transport/recording.h"

namespace leonav {
namespace {

class FileSource final : public ByteSource {
 public:
  FileSource(boost::asio::io_context* io, PlaybackClocks* clocks, const std::string& path)
      : clocks_(clocks), own_(clocks->speed), reader_(path), timer_(*io) {}

  void start(ByteSink* sink) override {
    sink_ = sink;
    wait_until(ArrivalClock::Steady::now());
  }

 private:
  using Time = ArrivalClock::Steady::time_point;

  void wait_until(Time time) {
    timer_.expires_at(time);
    timer_.async_wait([this](const boost::system::error_code& cancelled) {
      if (!cancelled) deliver();
    });
  }

  void deliver() {
    if (!is_open_) {
      is_open_ = true;
      sink_->on_open();
    } else if (block_.bytes.empty()) {
      // The first connection has begun with the file.
      if (has_brought_bytes_) sink_->on_open();
    } else {
      has_brought_bytes_ = true;
      sink_->on_bytes(block_.bytes,
                      reader_.is_recording() ? block_.arrival_ns : clocks_->arrival_ns());
    }
    try {
      if (!reader_.next(&block_)) return sink_->on_end("");
    } catch (const std::exception& error) {
      return sink_->on_end(error.what());
    }
    const Time now = ArrivalClock::Steady::now();
    wait_until(reader_.is_recording() ? clocks_->arrivals.due(block_.arrival_ns, now) : due(now));
  }

  // When the message that the next bytes may complete is due.
  Time due(Time now) {
    const std::optional<DataTime> time = sink_->data_time();
    if (!time) return now;
    constexpr std::int64_t kLongestInterval_ns = 2'000'000'000;
    PlaybackClock* clock = time->is_gps ? &clocks_->gps : &own_;
    if (last_ns_ == 0) clock->due(time->nanoseconds, now);  // begins here
    if (last_ns_ != 0 && time->nanoseconds != last_ns_) {
      interval_ns_ = std::clamp<std::int64_t>(time->nanoseconds - last_ns_, 0, kLongestInterval_ns);
    }
    last_ns_ = time->nanoseconds;
    return clock->due(last_ns_ + interval_ns_, now);
  }

  PlaybackClocks* clocks_;
  PlaybackClock own_;  // of a sensor's own clock
  BlockReader reader_;
  boost::asio::steady_timer timer_;
  ByteSink* sink_ = nullptr;
  bool is_open_ = false, has_brought_bytes_ = false;
  BlockReader::Block block_;
  std::int64_t last_ns_ = 0, interval_ns_ = 0;
};

}  // namespace

std::int64_t PlaybackClocks::arrival_ns() const {
  const auto elapsed = std::chrono::nanoseconds(ArrivalClock::Steady::now() - begin).count();
  return host->at_ns(begin) + static_cast<std::int64_t>(static_cast<double>(elapsed) * speed);
}

std::unique_ptr<ByteSource> make_file_source(boost::asio::io_context* io, PlaybackClocks* clocks,
                                             const std::string& path) {
  return std::make_unique<FileSource>(io, clocks, path);
}

}  // namespace leonav
