// A Stream joins a source, a format, a watch and, where it is asked for, a recording.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "drivers/transport/recording.h"
#include "drivers/transport/retry_wait.h"
#include "tools/connect/connect_config.h"
#include "tools/connect/formats/stream_format.h"
#include "tools/connect/stream_watch.h"

namespace leonav {

class Stream final : public ByteSink {
 public:
  // A connection that has brought nothing for so long, or for `silent_s` where that is longer, is
  // made anew: it may be dead without either side knowing.
  static constexpr double kReconnectAfter_s = 10.0;

  // `clock` must outlive this object. Throws FileError where the recording cannot be created.
  Stream(const StreamConfig& config, const ArrivalClock* clock, std::unique_ptr<ByteSource> source,
         std::unique_ptr<StreamFormat> format);

  void start();
  // Once a second: decides the state anew, logs what has changed, and writes the recording out.
  void look();
  // Ends the recording, which its own thread completes; then waits for that thread. The second
  // comes once all streams have been told to end, so that their disks are waited for together.
  void end_recording();
  void finish();

  const std::string& name() const { return name_; }
  const std::string& source_text() const { return source_text_; }
  const StreamWatch& watch() const { return watch_; }
  const StreamFormat& format() const { return *format_; }
  bool has_ended() const { return watch_.state() == StreamState::kEnded; }

 private:
  void on_open() override;
  void on_waiting(const std::string& what) override;
  void on_bytes(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void on_failure(const std::string& why, double retry_s) override;
  void on_end(const std::string& why) override;
  std::optional<DataTime> data_time() const override { return format_->data_time(); }
  void tell_news();
  void look_at_recording();
  void tell_recording_error();

  std::string name_, source_text_;
  const ArrivalClock* clock_;
  std::unique_ptr<ByteSource> source_;
  std::unique_ptr<StreamFormat> format_;
  StreamWatch watch_;
  double reconnect_after_s_;
  std::unique_ptr<RecordingWriter> recording_;
  bool is_recording_ = false;       // it has not ended
  bool limit_is_told_ = false;      // that it is near
  std::uint64_t told_dropped_ = 0;  // bytes that the recording lacks
  StreamState told_ = StreamState::kConnecting;
  std::string told_failure_;
};

}  // namespace leonav
