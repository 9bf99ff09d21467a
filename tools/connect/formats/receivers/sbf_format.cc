#include "tools/connect/formats/receivers/sbf_format.h"

#include <algorithm>

namespace leonav {

void SbfFormat::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  decoder_.feed(bytes, this);
}

void SbfFormat::on_epoch(const RawEpoch& epoch) { receiver_.send(epoch, arrival_ns_); }
void SbfFormat::on_ephemeris(const Ephemeris& ephemeris) { receiver_.send(ephemeris); }
void SbfFormat::on_klobuchar(const KlobucharModel& model) {
  receiver_.send(model, receiver_.last_epoch().plus_seconds(latency_s_));
}

void SbfFormat::on_imu(const ExtSensorRates& rates) {
  if (!options_.is_inertial) return;
  last_sample_ = rates.time;
  const std::optional<ImuSample> sample = samples_.take(rates);
  if (!sample) return;
  output_->send(*sample);
  output_->note_time(sample->time);
  ++sent_samples_;
}

FormatCounts SbfFormat::counts() const {
  const SbfCounters c = decoder_.counters();
  const ImuSamplerCounters& s = samples_.counters();
  FormatCounts counts;
  counts.frames = c.framer.blocks;
  counts.messages = receiver_.messages() + pages_.published() + sent_samples_;
  counts.epochs = receiver_.epochs();
  counts.empty_epochs = receiver_.empty_epochs();
  counts.damaged =
      c.framer.bad_checksums + c.framer.bad_lengths + c.framer.incomplete + pages_.damaged();
  counts.refused = c.measurements.bad_length + c.measurements.without_time +
                   c.measurements.scrambled + c.epochs.bad_value + c.epochs.bad_satellite +
                   c.navigation.bad_parity + c.navigation.bad_week + c.navigation.wrong_satellite +
                   c.navigation.not_sane + c.raw.bad_length + c.raw.bad_satellite +
                   c.raw.crc_failed + c.raw.bad_pages + c.raw.wrong_satellite + pages_.refused() +
                   c.decoded.bad_length + c.decoded.bad_satellite + c.decoded.bad_time +
                   c.decoded.bad_week + c.decoded.bad_subframes + c.decoded.not_sane +
                   c.decoded.bad_ionosphere;
  if (options_.is_inertial) {
    counts.samples = sent_samples_;
    counts.refused +=
        c.imu.bad_length + c.imu.without_time + c.imu.bad_value + s.out_of_order + s.impossible;
  }
  return counts;
}

std::optional<DataTime> SbfFormat::data_time() const {
  const GpsTime time = std::max(last_sample_, receiver_.last_epoch());
  if (!time.is_set()) return std::nullopt;
  return DataTime{true, time.nanoseconds()};
}

const char* SbfFormat::ephemeris_remedy(System system) {
  switch (system) {
    case System::kGps:
      return "turn on GPSRawCA or GPSNav";
    case System::kGalileo:
      return "turn on GALRawINAV or GALNav";
    default:
      return "turn on BDSRaw or BDSNav";
  }
}

std::string SbfFormat::inertial_text() const {
  const ExtSensorCounters imu = decoder_.counters().imu;
  if (!options_.is_inertial) {
    return imu.samples > 0 ? "inertial data that are not published ('inertial: true' does)" : "";
  }
  if (sent_samples_ > 0) return std::to_string(sent_samples_) + " inertial samples";
  if (imu.without_time > 0) return "inertial data without a time: the receiver has no fix yet";
  if (imu.without_motion > 0) {
    return "inertial data without both angular rate and acceleration: is the sensor an IMU?";
  }
  return "no inertial samples yet: turn on ExtSensorMeas";
}

std::string SbfFormat::detail() const {
  // Samples alone must not hide a receiver that gives no epochs.
  const std::string missing = receiver_.last_epoch().is_set() ? "" : why_no_messages();
  return joined(
      {missing, receiver_.detail(), summary_of(decoder_.counters().losses),
       pages_.text("no pages of Galileo HAS or PPP-B2b: turn on GALRawCNAV and BDSRawB2b, "
                   "and their signals GALE6BC and BDSB2b"),
       inertial_text()});
}

std::string SbfFormat::why_no_frames() const {
  const SbfFramerCounters c = decoder_.counters().framer;
  if (c.text_bytes * 10 > c.bytes_skipped * 9) {
    return "text arrives, but no SBF block: turn SBF on for this port with setDataInOut and "
           "setSBFOutput, and NMEA off";
  }
  return "bytes arrive but no valid SBF block: is the baud rate right, and is it a Septentrio "
         "receiver?";
}

std::string SbfFormat::why_no_messages() const {
  const SbfCounters c = decoder_.counters();
  if (c.measurements.scrambled > 0) {
    return "the receiver scrambles its measurements: it lacks the permission for raw measurements "
           "(lstInternalFile Permissions shows it)";
  }
  if (c.measurements.without_time > 0) {
    return "MeasEpoch comes without a time: the receiver has no fix yet";
  }
  if (c.measurements.bad_length > 0) {
    return "MeasEpoch comes in a form that is not known: is the firmware newer than this program?";
  }
  std::string others;
  for (const auto& [number, count] : c.unused) {
    if (others.size() > 120) continue;
    others += (others.empty() ? " (" : ", ") + unused_block_text(number);
  }
  if (!others.empty()) others += ")";
  return "SBF blocks arrive, but no MeasEpoch" + others +
         ": turn on MeasEpoch, GPSRawCA, GALRawINAV and BDSRaw" +
         (options_.is_inertial ? ", and ExtSensorMeas" : "");
}

}  // namespace leonav
