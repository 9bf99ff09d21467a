#include "tools/connect/rtcm3_format.h"

#include <string_view>

#include "tools/common/format.h"
#include "tools/import/product_schedule.h"

namespace leonav {

void Rtcm3Format::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  if (is_live_) decoder_.tell_time(host_.at(arrival_ns).value_or(GpsTime()));
  decoder_.feed(bytes, this);
}

void Rtcm3Format::on_epoch(const RawEpoch& epoch) {
  clock_->on_epoch(epoch.time, arrival_ns_);
  last_epoch_ = epoch.time;
  last_signals_ = epoch.observations.size();
  output_->send(epoch);
  output_->note_time(epoch.time);
  ++messages_;
  messages_ += static_cast<std::uint64_t>(repeater_.repeat(epoch.time));
}

void Rtcm3Format::on_ephemeris(const Ephemeris& ephemeris) {
  Ephemeris sent = ephemeris;
  sent.transmission_time = transmission_time(ephemeris);
  output_->send(sent);
  repeater_.remember(sent, last_epoch_.is_set() ? last_epoch_ : sent.transmission_time);
  ++messages_;
  ++ephemerides_;
}

FormatCounts Rtcm3Format::counts() const {
  const Rtcm3Counters c = decoder_.counters();
  FormatCounts counts;
  counts.frames = c.framer.frames;
  counts.messages = messages_;
  counts.damaged = c.framer.bad_checksums + c.framer.incomplete + c.framer.too_short;
  counts.refused = c.epochs.bad_length + c.epochs.bad_mask + c.epochs.bad_time + c.epochs.late +
                   c.epochs.other_station + c.epochs.without_reference +
                   c.epochs.without_full_range + c.measurements.bad_value +
                   c.measurements.bad_satellite + c.ephemerides.bad_length +
                   c.ephemerides.bad_satellite + c.ephemerides.bad_time + c.ephemerides.bad_week +
                   c.ephemerides.not_sane + c.ephemerides.without_reference;
  return counts;
}

std::optional<DataTime> Rtcm3Format::data_time() const {
  if (!last_epoch_.is_set()) return std::nullopt;
  return DataTime{true, last_epoch_.nanoseconds()};
}

std::string Rtcm3Format::detail() const {
  if (!last_epoch_.is_set() && ephemerides_ == 0) return "";
  return format("%zu signals in the last epoch, %llu ephemerides", last_signals_,
                static_cast<unsigned long long>(ephemerides_));
}

std::string Rtcm3Format::why_no_frames() const {
  return "bytes arrive but no valid RTCM 3 message: is the baud rate right, and does the sender "
         "send RTCM 3?";
}

std::string Rtcm3Format::why_no_messages() const {
  const Rtcm3Counters c = decoder_.counters();
  if (c.epochs.without_full_range > 0) {
    return "MSM1 to MSM3 arrive, whose ranges lack the milliseconds: let the sender send MSM4 to "
           "MSM7";
  }
  std::string others;
  for (const auto& [number, count] : c.unused) {
    const std::string_view what = unused_message_text(number);
    if (others.size() > 120 || what.empty()) continue;
    others += (others.empty() ? " (" : ", ") + std::to_string(number) + " " + std::string(what);
  }
  if (!others.empty()) others += ")";
  return "RTCM 3 arrives, but neither observations of GPS, Galileo or BeiDou nor ephemerides" +
         others + ": let the sender send MSM4 to MSM7, and 1019, 1042, 1045 or 1046";
}

}  // namespace leonav
