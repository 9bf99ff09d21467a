#include "tools/connect/formats/ubx_format.h"

namespace leonav {

void UbxFormat::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  decoder_.feed(bytes, this);
}

void UbxFormat::on_epoch(const RawEpoch& epoch) { receiver_.send(epoch, arrival_ns_); }
void UbxFormat::on_ephemeris(const Ephemeris& ephemeris) { receiver_.send(ephemeris); }
void UbxFormat::on_klobuchar(const KlobucharModel& model) {
  receiver_.send(model, receiver_.last_epoch().plus_seconds(latency_s_));
}
void UbxFormat::on_biases(const std::vector<SignalBias>& biases) { receiver_.send(biases); }

FormatCounts UbxFormat::counts() const {
  const UbxCounters c = decoder_.counters();
  FormatCounts counts;
  counts.frames = c.framer.messages;
  counts.messages = receiver_.messages();
  counts.damaged = c.framer.bad_checksums + c.framer.oversize + c.framer.incomplete;
  counts.refused = c.rawx.bad_length + c.rawx.bad_version + c.rawx.bad_time + c.rawx.bad_value +
                   c.rawx.bad_satellite + c.sfrbx.bad_length + c.sfrbx.bad_version +
                   c.sfrbx.bad_satellite + c.sfrbx.bad_parity + c.sfrbx.bad_week +
                   c.sfrbx.wrong_satellite + c.sfrbx.not_sane;
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
