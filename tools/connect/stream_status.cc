#include "tools/connect/stream_status.h"

#include <cmath>

#include "tools/common/format.h"

namespace leonav {
namespace {

stream_t stream_message(const Stream& stream, std::int64_t now_ns) {
  const StreamWatch& watch = stream.watch();
  const FormatCounts counts = stream.format().counts();
  stream_t message;
  message.name = stream.name();
  message.state = name_of(watch.state());
  message.detail = watch.text();
  message.bytes = static_cast<std::int64_t>(watch.bytes());
  message.frames = static_cast<std::int64_t>(counts.frames);
  message.messages = static_cast<std::int64_t>(counts.messages);
  message.damaged = static_cast<std::int64_t>(counts.damaged);
  message.refused = static_cast<std::int64_t>(counts.refused);
  message.failures = static_cast<std::int64_t>(watch.failures());
  message.byte_age_s = watch.byte_age_s(now_ns);
  message.message_age_s = watch.message_age_s(now_ns);
  message.stamp_sigma_s = stream.format().stamp_sigma_s();
  return message;
}

}  // namespace

streams_t streams_message(const std::vector<std::unique_ptr<Stream>>& streams, GpsTime time,
                          std::uint64_t sequence, std::int64_t now_ns) {
  streams_t message;
  message.time_ns = time.nanoseconds();
  message.sequence = static_cast<std::int64_t>(sequence);
  message.schema = 1;
  for (const auto& stream : streams) message.streams.push_back(stream_message(*stream, now_ns));
  message.n = static_cast<std::int32_t>(message.streams.size());
  return message;
}

std::string status_text(const Stream& stream, std::int64_t now_ns) {
  const stream_t s = stream_message(stream, now_ns);
  std::string text =
      format("%s: %s, %lld bytes, %lld messages, %lld damaged, %lld refused", s.name.c_str(),
             s.state.c_str(), static_cast<long long>(s.bytes), static_cast<long long>(s.messages),
             static_cast<long long>(s.damaged), static_cast<long long>(s.refused));
  if (std::isfinite(s.byte_age_s)) text += format(", last byte %.1f s ago", s.byte_age_s);
  if (!s.detail.empty()) text += "; " + s.detail;
  return text;
}

}  // namespace leonav
