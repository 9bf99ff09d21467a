// The StreamWriter sends a queue to a socket, a serial port or a pseudo-terminal without blocking.
#pragma once
#include <spdlog/spdlog.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "tools/serve/output_queue.h"

namespace leonav {

// One reader. It keeps itself alive while an operation runs; close() ends it.
template <typename Stream>
class StreamWriter : public std::enable_shared_from_this<StreamWriter<Stream>> {
 public:
  using Closed = std::function<void(const boost::system::error_code&)>;

  // `name` is for logs.
  StreamWriter(Stream stream, std::string name)
      : stream_(std::move(stream)), name_(std::move(name)) {}

  // `on_closed` is called once, when writing fails.
  void start(Closed on_closed) {
    on_closed_ = std::move(on_closed);
    discard_input();
  }

  // What readers send is thrown away, so that it does not fill the buffers on the way. Ends at an
  // error: a client may close its sending half and read on.
  void discard_input() {
    if (is_reading_) return;
    is_reading_ = true;
    stream_.async_read_some(
        boost::asio::buffer(unused_),
        [self = this->shared_from_this()](const boost::system::error_code& error, std::size_t) {
          self->is_reading_ = false;
          if (!error) self->discard_input();
        });
  }

  void send(const std::shared_ptr<const Batch>& batch) {
    if (!is_open_) return;
    const bool had_room = queue_.offer(batch);
    if (!had_room && !is_losing_) {
      spdlog::warn(
          "{}: reads too slowly and loses sentences; lower rate_hz or name fewer sentences", name_);
    } else if (had_room && is_losing_) {
      spdlog::info("{}: reads again; {} sentences lost so far", name_, queue_.lost_sentences());
    }
    is_losing_ = !had_room;
    write();
  }

  void forget() { queue_.clear(); }
  std::uint64_t lost_sentences() const { return queue_.lost_sentences(); }
  const std::string& name() const { return name_; }
  Stream& stream() { return stream_; }

  void close() {
    is_open_ = false;
    boost::system::error_code ignored;
    stream_.close(ignored);
  }

 private:
  void write() {
    if (is_writing_ || queue_.is_empty() || !is_open_) return;
    is_writing_ = true;
    // The bytes are copied: the queue may be cleared while the operation runs.
    chunk_.assign(queue_.data(), queue_.size());
    queue_.consume(chunk_.size());
    write_chunk(0);
  }

  void write_chunk(std::size_t from) {
    stream_.async_write_some(boost::asio::buffer(chunk_.data() + from, chunk_.size() - from),
                             [self = this->shared_from_this(), from](
                                 const boost::system::error_code& error, std::size_t count) {
                               if (error) return self->fail(error);
                               // A pseudo-terminal takes nothing while nobody has it open: the next
                               // batch tries again.
                               const bool is_done =
                                   count == 0 || from + count >= self->chunk_.size();
                               if (!is_done) return self->write_chunk(from + count);
                               self->is_writing_ = false;
                               if (count > 0) self->write();
                             });
  }

  void fail(const boost::system::error_code& error) {
    if (!is_open_) return;
    close();
    if (on_closed_) on_closed_(error);
  }

  Stream stream_;
  std::string name_, chunk_;
  Closed on_closed_;
  OutputQueue queue_;
  bool is_open_ = true, is_writing_ = false, is_losing_ = false;
  bool is_reading_ = false;
  std::array<char, 512> unused_;
};

}  // namespace leonav
