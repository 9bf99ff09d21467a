#include "tools/connect/formats/receivers/rtcm3_format.h"

#include <string_view>

#include "drivers/binary/week_time.h"
#include "tools/common/format.h"

namespace leonav {
namespace {

// A list of messages that are not used is cut there.
constexpr std::size_t kLongestList = 120;
// So many numbers are told: noise that passes for messages can have any of 4096.
constexpr std::size_t kMostUnused = 40;

}  // namespace

void Rtcm3Format::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  if (is_live_) tell_time();
  decoder_.feed(bytes, this);
}

// The host knows the week. The time in it is that of the stream's last epoch and what has passed
// since, or of the epochs of another stream.
void Rtcm3Format::tell_time() {
  const GpsTime host = clock_->by_host(arrival_ns_);
  if (last_epoch_.is_set()) {
    const GpsTime now = last_epoch_.plus_nanoseconds(arrival_ns_ - last_epoch_ns_);
    const std::int64_t of_week_ns = now.nanoseconds() - now.week() * kNanosecondsPerWeek;
    decoder_.tell_time(nearest_instant_ns(of_week_ns, host));
  } else if (const auto now = clock_->at(arrival_ns_)) {
    decoder_.tell_time(*now);
  } else {
    decoder_.tell_week(host);
  }
}

void Rtcm3Format::on_epoch(const RawEpoch& epoch) {
  last_epoch_ = epoch.time;
  last_epoch_ns_ = arrival_ns_;
  if (is_service_) {
    ++station_epochs_;
  } else {
    receiver_.send(epoch, arrival_ns_, false);
  }
}
void Rtcm3Format::on_ephemeris(const Ephemeris& ephemeris) {
  receiver_.send(ephemeris, service_time());
}

// It comes with each valid ephemeris, also with one that came before.
void Rtcm3Format::on_stated_toe(GpsTime time) {
  clock_->confirm_host(time, arrival_ns_);
  if (const GpsTime now = service_time(); now.is_set()) receiver_.repeat_navigation(now);
}

// Observations of a service are not used, and so nothing depends on where they were made.
void Rtcm3Format::on_station_position(const StationPosition& position) {
  if (!is_service_) station_.take(position);
}

void Rtcm3Format::on_ssr(const SsrMessage& message) {
  if (corrections_ == nullptr) return;
  if (message.time > last_ssr_) last_ssr_ = message.time;
  const GpsTime now = time_of_arrival(message.time);
  ssr_messages_ += static_cast<std::uint64_t>(corrections_->take(message, now));
  if (is_service_) receiver_.repeat_navigation(now);
}

// A receiver's epochs know it best, then the host; of a file the messages' own times are all.
GpsTime Rtcm3Format::time_of_arrival(GpsTime of_message) const {
  if (!is_live_) return of_message;
  if (const auto time = clock_->at(arrival_ns_)) return *time;
  return clock_->by_host(arrival_ns_);
}

GpsTime Rtcm3Format::service_time() const {
  return is_service_ && is_live_ ? time_of_arrival({}) : GpsTime();
}

std::optional<DataTime> Rtcm3Format::data_time() const {
  if (const auto of_epochs = receiver_.data_time()) return of_epochs;
  if (!last_ssr_.is_set()) return std::nullopt;
  return DataTime{true, last_ssr_.nanoseconds()};
}

std::string Rtcm3Format::detail() const {
  return joined({week_text(), receiver_.detail(), station_text(), station_.text(),
                 summary_of(decoder_.counters().losses),
                 last_ssr_.is_set() ? corrections_->detail() : "", host_doubt()});
}

// What is taken from the host's clock while nothing shows that it is right.
std::string Rtcm3Format::host_doubt() const {
  if (!is_live_) return "";
  const bool week = !clock_->host_week_is_confirmed();
  const bool age = last_ssr_.is_set() && !clock_->at(arrival_ns_);
  if ((!week && !age) || !clock_->host_is_unsynchronised()) return "";
  return std::string("the host's clock is not synchronised, and ") +
         (week ? "the week of these messages is" : "the age of these corrections is") +
         " taken from it: is a time service running (timedatectl)?";
}

// One satellite may send old elements for long.
std::string Rtcm3Format::week_text() const {
  constexpr std::uint64_t kEnough = 3;
  if (decoder_.counters().ephemerides.other_week_in_row < kEnough) return "";
  return std::string("the ephemerides are of another week than ") +
         (is_live_ ? "the host's clock shows, which gives the week of all times: set it "
                     "(timedatectl)"
                   : "'date' says: is it the day of the recording?");
}

const char* Rtcm3Format::ephemeris_remedy(System system) {
  switch (system) {
    case System::kGps:
      return "let the sender send 1019, or add a stream of broadcast ephemerides";
    case System::kGalileo:
      return "let the sender send 1045 or 1046, or add a stream of broadcast ephemerides";
    default:
      return "let the sender send 1042, or add a stream of broadcast ephemerides";
  }
}

std::string Rtcm3Format::station_text() const {
  const EpochAssemblyCounters epochs = decoder_.counters().epochs;
  if (epochs.station_changes == 0) return "";
  return leonav::format("its station has changed %llu times, the last from %d to %d",
                        static_cast<unsigned long long>(epochs.station_changes),
                        int{epochs.station_before}, int{epochs.station});
}

std::vector<FormatNews> Rtcm3Format::take_news() {
  std::vector<FormatNews> news = warnings_of({receiver_.take_news(), station_.take_news()});
  const std::string unused = unused_news();
  if (!unused.empty()) news.push_back({false, unused});
  return news;
}

// Each number once; what is cut off the list comes at the next call.
std::string Rtcm3Format::unused_news() {
  std::string text;
  for (const auto& [number, count] : decoder_.counters().unused) {
    if (text.size() > kLongestList || others_are_told_) break;
    if (told_unused_.contains(number)) continue;
    if (told_unused_.size() == kMostUnused) {
      others_are_told_ = true;
      text += text.empty() ? "not used: others, which are not named" : ", and others";
      break;
    }
    told_unused_.insert(number);
    text += (text.empty() ? "not used: " : ", ") + std::to_string(number) + " " +
            std::string(unused_message_text(number));
  }
  return text;
}

FormatCounts Rtcm3Format::counts() const {
  const Rtcm3Counters c = decoder_.counters();
  FormatCounts counts;
  counts.frames = c.framer.frames;
  // Ephemerides, which come again and again, must not hide that no correction can be used.
  const bool has_corrections = is_service_ && last_ssr_.is_set();
  // A service of ephemerides alone lives as long as it sends them, new or not.
  const std::uint64_t of_ephemerides =
      receiver_.messages() + (is_service_ ? c.ephemerides.repeated : 0);
  counts.messages = ssr_messages_ + (has_corrections ? 0 : of_ephemerides);
  counts.epochs = receiver_.epochs();
  counts.empty_epochs = receiver_.empty_epochs();
  counts.damaged = c.framer.bad_checksums + c.framer.incomplete + c.framer.too_short;
  counts.refused = c.epochs.bad_length + c.epochs.bad_mask + c.epochs.bad_time + c.epochs.late +
                   c.epochs.other_station + c.epochs.without_reference +
                   c.epochs.without_full_range + c.measurements.bad_value +
                   c.measurements.bad_satellite + c.ephemerides.bad_length +
                   c.ephemerides.bad_satellite + c.ephemerides.bad_time + c.ephemerides.bad_week +
                   c.ephemerides.not_sane + c.ephemerides.without_reference + c.ssr.bad_length +
                   c.ssr.bad_time + c.ssr.without_reference;
  return counts;
}

std::string Rtcm3Format::why_no_frames() const {
  return "bytes arrive but no valid RTCM 3 message: is the baud rate right, and does the sender "
         "send RTCM 3?";
}

std::string Rtcm3Format::why_none() const {
  const Rtcm3Counters c = decoder_.counters();
  if (c.epochs.without_full_range > 0) {
    return "MSM1 to MSM3 arrive, whose ranges lack the milliseconds: let the sender send MSM4 to "
           "MSM7";
  }
  if (last_ssr_.is_set()) return "SSR messages arrive, but " + corrections_->why_none();
  if (c.epochs.other_station > 0 && receiver_.messages() == 0) {
    return "observations of several stations arrive, and those of the first one cannot be used: "
           "let the sender send one station alone";
  }
  if (station_epochs_ > 0) {
    return "observations arrive, but no SSR messages, in a stream of 'corrections: true'; leave "
           "that key out for a receiver";
  }
  std::string others;
  for (const auto& [number, count] : c.unused) {
    const std::string_view what = unused_message_text(number);
    if (others.size() > kLongestList || what.empty()) continue;
    others += (others.empty() ? " (" : ", ") + std::to_string(number) + " " + std::string(what);
  }
  if (!others.empty()) others += ")";
  return "RTCM 3 arrives, but neither observations of GPS, Galileo or BeiDou nor ephemerides" +
         others + ": let the sender send MSM4 to MSM7, and 1019, 1042, 1045 or 1046";
}

}  // namespace leonav
