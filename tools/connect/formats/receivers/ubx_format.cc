#include "tools/connect/formats/receivers/ubx_format.h"

#include "tools/import/ubx_samples.h"

namespace leonav {

void UbxFormat::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  // Subframes hold no time of reception, and get that of the last epoch.
  constexpr std::int64_t kLongestEpochAge_ns = 60'000'000'000;
  if (arrival_ns - epoch_arrival_ns_ > kLongestEpochAge_ns) decoder_.forget_time();
  arrival_ns_ = arrival_ns;
  decoder_.feed(bytes, this);
}

void UbxFormat::on_epoch(const RawEpoch& epoch) {
  epoch_arrival_ns_ = arrival_ns_;
  receiver_.send(epoch, arrival_ns_);
}
void UbxFormat::on_ephemeris(const Ephemeris& ephemeris) { receiver_.send(ephemeris); }
void UbxFormat::on_klobuchar(const KlobucharModel& model) {
  receiver_.send(model, receiver_.last_epoch().plus_seconds(latency_s_));
}
void UbxFormat::on_biases(const std::vector<SignalBias>& biases) { receiver_.send(biases); }

void UbxFormat::on_inertial(const EsfReading& reading) {
  if (options_.is_inertial) imu_.take(imu_reading(reading, arrival_ns_));
}

void UbxFormat::on_time_mark(const TimeMark& mark) {
  if (pulses_ == nullptr) return;
  const PulseInput& input = options_.pulse_input;
  const std::optional<GpsTime>& edge = input.is_falling ? mark.falling : mark.rising;
  if (mark.input != input.input || !edge) {
    ++other_pulses_;
    return;
  }
  ++sent_pulses_;
  pulses_->push({edge->plus_seconds(-input.delay_s), mark.accuracy_s});
}

// B-CNAV1 of B1C has no group delays of B1I.
const char* UbxFormat::ephemeris_remedy(System system) {
  return system == System::kBeidou
             ? "switch UBX-RXM-SFRBX on for this port of the receiver, and B1I "
               "(CFG-SIGNAL-BDS_B1_ENA)"
             : "switch UBX-RXM-SFRBX on for this port of the receiver";
}

std::string UbxFormat::inertial_text() const {
  const EsfCounters esf = decoder_.counters().esf;
  if (!options_.is_inertial) {
    return esf.readings > 0 ? "inertial data that are not published ('inertial: true' does)" : "";
  }
  if (esf.readings == 0) {
    return "no inertial samples yet: switch UBX-ESF-RAW on for this port of the receiver";
  }
  return std::to_string(imu_.messages()) + " inertial samples, " + imu_.text();
}

std::string UbxFormat::pulse_text() const {
  if (pulses_ == nullptr) return "";
  const TimTm2Counters marks = decoder_.counters().time_marks;
  if (sent_pulses_ > 0) return std::to_string(sent_pulses_) + " pulses";
  if (other_pulses_ > 0) {
    return "pulses at another input or with another edge than 'time.pulse' says";
  }
  if (marks.without_time > 0) return "pulses, but no GPS time for them yet";
  return "no pulses: switch UBX-TIM-TM2 on for this port of the receiver";
}

std::string UbxFormat::detail() const {
  return joined({receiver_.detail(),
                 pages_.text("no pages of Galileo HAS: switch E6 on (CFG-SIGNAL-GAL_E6_ENA)"),
                 inertial_text(), pulse_text()});
}

double UbxFormat::stamp_sigma_s() const {
  return options_.is_inertial ? imu_.sigma_s() : StreamFormat::stamp_sigma_s();
}

FormatCounts UbxFormat::counts() const {
  const UbxCounters c = decoder_.counters();
  FormatCounts counts;
  counts.frames = c.framer.messages;
  counts.messages = receiver_.messages() + pages_.published();
  counts.epochs = receiver_.epochs();
  counts.empty_epochs = receiver_.empty_epochs();
  counts.damaged =
      c.framer.bad_checksums + c.framer.oversize + c.framer.incomplete + pages_.damaged();
  counts.refused = c.rawx.bad_length + c.rawx.bad_version + c.rawx.bad_time + c.rawx.bad_value +
                   c.rawx.bad_satellite + c.sfrbx.bad_length + c.sfrbx.bad_version +
                   c.sfrbx.bad_satellite + c.sfrbx.bad_parity + c.sfrbx.bad_week +
                   c.sfrbx.wrong_satellite + c.sfrbx.not_sane + c.esf.bad_length +
                   c.time_marks.bad_length + c.time_marks.bad_time + pages_.refused();
  if (options_.is_inertial) {
    counts.samples = imu_.messages();
    counts.messages += imu_.messages();
    counts.refused += c.esf.incomplete + imu_.refused();
  }
  return counts;
}

std::string UbxFormat::why_no_frames() const {
  const ForeignMessageCounters foreign = decoder_.counters().framer.foreign;
  if (foreign.nmea_sentences > 0) {
    return "NMEA sentences arrive, but no UBX message: switch UBX-RXM-RAWX and UBX-RXM-SFRBX on "
           "for this port of the receiver";
  }
  if (foreign.rtcm3_frames > 0) {
    return "RTCM 3 arrives, but no UBX message: switch UBX-RXM-RAWX and UBX-RXM-SFRBX on for this "
           "port of the receiver";
  }
  return "bytes arrive but no valid UBX message: is the baud rate right, and is it a u-blox "
         "receiver?";
}

std::string UbxFormat::why_no_messages() const {
  const RxmRawxCounters rawx = decoder_.counters().rawx;
  if (rawx.bad_time > 0) return "UBX-RXM-RAWX comes without a time: the receiver has no fix yet";
  if (rawx.bad_version + rawx.bad_length > 0) {
    return "UBX-RXM-RAWX comes in a version that is not known: the firmware is older than "
           "protocol 18, or newer than this program";
  }
  return "UBX messages arrive, but no UBX-RXM-RAWX: switch it and UBX-RXM-SFRBX on for this port "
         "of the receiver";
}

}  // namespace leonav
