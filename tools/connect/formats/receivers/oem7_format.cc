#include "tools/connect/formats/receivers/oem7_format.h"

#include <algorithm>

namespace leonav {

void Oem7Format::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  decoder_.feed(bytes, this);
}

void Oem7Format::on_epoch(const RawEpoch& epoch) { receiver_.send(epoch, arrival_ns_); }
void Oem7Format::on_ephemeris(const Ephemeris& ephemeris) { receiver_.send(ephemeris); }
void Oem7Format::on_klobuchar(const KlobucharModel& model) {
  receiver_.send(model, receiver_.last_epoch().plus_seconds(latency_s_));
}

void Oem7Format::on_imu(const RawImuIncrements& increments) {
  if (!options_.is_inertial) return;
  last_sample_ = increments.time;
  const std::optional<ImuSample> sample = samples_.take(increments);
  if (!sample) return;
  output_->send(*sample);
  output_->note_time(sample->time);
  ++sent_samples_;
}

FormatCounts Oem7Format::counts() const {
  const Oem7Counters c = decoder_.counters();
  const ImuSamplerCounters& s = samples_.counters();
  FormatCounts counts;
  counts.frames = c.framer.messages;
  counts.messages = receiver_.messages() + sent_samples_;
  counts.epochs = receiver_.epochs();
  counts.empty_epochs = receiver_.empty_epochs();
  counts.damaged = c.framer.bad_checksums + c.framer.bad_headers + c.framer.incomplete;
  counts.refused = c.ranges.bad_length + c.ranges.without_time + c.ranges.without_reference +
                   c.epochs.bad_value + c.epochs.bad_satellite + c.ephemerides.bad_length +
                   c.ephemerides.bad_satellite + c.ephemerides.bad_time + c.ephemerides.bad_week +
                   c.ephemerides.bad_subframes + c.ephemerides.not_sane +
                   c.ephemerides.bad_ionosphere;
  if (options_.is_inertial) {
    counts.samples = sent_samples_;
    counts.refused += c.imu.bad_length + c.imu.bad_time + c.imu.sensor_errors + c.imu.encrypted +
                      c.imu.unknown_scale + s.out_of_order + s.impossible;
  }
  return counts;
}

std::optional<DataTime> Oem7Format::data_time() const {
  const GpsTime time = std::max(last_sample_, receiver_.last_epoch());
  if (!time.is_set()) return std::nullopt;
  return DataTime{true, time.nanoseconds()};
}

// ONCHANGED sends what there is when it is asked for, and then what is new: nothing at first to a
// program that comes later.
const char* Oem7Format::ephemeris_remedy(System system) {
  switch (system) {
    case System::kGps:
      return "log RAWEPHEMB ONCHANGED; if it is logged already, once more, which sends it at once";
    case System::kGalileo:
      return "log GALINAVEPHEMERISB and GALFNAVEPHEMERISB ONCHANGED; if they are logged already, "
             "once more, which sends them at once";
    default:
      return "log BDSEPHEMERISB ONCHANGED; if it is logged already, once more, which sends it at "
             "once";
  }
}

std::string Oem7Format::inertial_text() const {
  const RawImuCounters imu = decoder_.counters().imu;
  if (!options_.is_inertial) {
    return imu.samples + imu.unknown_scale > 0
               ? "inertial data that are not published ('inertial: true' does)"
               : "";
  }
  if (const std::string problem = problem_of_scale(imu); !problem.empty()) return problem;
  if (imu.encrypted > 0) return "inertial data that the receiver has encrypted";
  if (sent_samples_ == 0) return "no inertial samples yet: log RAWIMUSXB ONNEW";
  return std::to_string(sent_samples_) + " inertial samples";
}

std::string Oem7Format::detail() const {
  // Samples alone must not hide a receiver that gives no epochs.
  const std::string missing = receiver_.last_epoch().is_set() ? "" : why_no_messages();
  return joined(
      {missing, receiver_.detail(), summary_of(decoder_.counters().losses), inertial_text()});
}

std::string Oem7Format::why_no_frames() const {
  const Oem7FramerCounters c = decoder_.counters().framer;
  if (c.text_bytes * 10 > c.bytes_skipped * 9) {
    return "text arrives, but no binary message: log the names that end in B, as RANGECMPB, and "
           "switch NMEA off for this port";
  }
  return "bytes arrive but no valid NovAtel message: is the baud rate right, and is it a receiver "
         "of the kinds OEM4 to OEM7?";
}

std::string Oem7Format::why_no_messages() const {
  const Oem7Counters c = decoder_.counters();
  if (options_.is_inertial) {
    if (const std::string problem = problem_of_scale(c.imu); !problem.empty()) return problem;
  }
  if (c.ranges.without_time > 0) {
    return "range logs come without a time: the receiver has no fix yet";
  }
  if (c.ranges.bad_length > 0) {
    return "range logs come in a form that is not known: is the firmware newer than this program?";
  }
  std::string others;
  for (const auto& [number, count] : c.unused) {
    if (others.size() > 120) continue;
    others += (others.empty() ? " (" : ", ") + unused_log_text(number);
  }
  if (!others.empty()) others += ")";
  return "NovAtel messages arrive, but no range log" + others +
         ": log RANGECMPB ONTIME 1, RAWEPHEMB, GALINAVEPHEMERISB, GALFNAVEPHEMERISB and "
         "BDSEPHEMERISB ONCHANGED" +
         (options_.is_inertial ? ", and RAWIMUSXB ONNEW" : "");
}

}  // namespace leonav
