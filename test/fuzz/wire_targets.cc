// The formats of leonav-connect, fed as a stream delivers them: in pieces of any length.
#include <algorithm>
#include <array>
#include <functional>
#include <memory>

#include "daemon/messages/encoding_sink.h"
#include "daemon/messages/input_dispatch.h"
#include "support/sky/simulated_sky.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/checksum_repair.h"
#include "test/fuzz/target_groups.h"
#include "tools/connect/formats/inertial/imu_line_format.h"
#include "tools/connect/formats/inertial/vectornav_format.h"
#include "tools/connect/formats/inertial/xsens_format.h"
#include "tools/connect/formats/pages/page_format.h"
#include "tools/connect/formats/receivers/oem7_format.h"
#include "tools/connect/formats/receivers/rtcm3_format.h"
#include "tools/connect/formats/receivers/sbf_format.h"
#include "tools/connect/formats/receivers/ubx_format.h"

namespace leonav::test {
namespace {

constexpr double kLatency_s = 0.05;

// Every message that is published must be one that leonavd takes: whoever encodes has to refuse
// what the Decoder would.
class CheckedMessages : public MessageTarget {
 public:
  void take(Channel channel, ByteSpan bytes) override {
    static InputDispatch dispatch(nullptr);  // decodes alone
    const InputFault fault = dispatch.decode(channel, bytes);
    if (fault == InputFault::kNone) return;
    throw Finding(std::string(name_of(channel)) +
                  " is published although leonavd refuses it: " + std::string(to_string(fault)));
  }
};

constexpr std::int64_t kBegin_ns = 1'000'000'000;
constexpr const char* kStream = "fuzz";

// A receiver's epochs have tied arrivals to GPS time, as most sensors need it.
GpsClock tied_clock() {
  GpsClock clock{TimeReference::kGnss, kLatency_s};
  for (int k = 0; k < 20; ++k) {
    const double s = 0.1 * k;
    clock.on_epoch(kSkyEpoch.plus_seconds(s), kBegin_ns + static_cast<std::int64_t>(s * 1e9));
  }
  return clock;
}

// Another stream has brought ephemerides, so that corrections have something to correct.
CorrectionServices services_with_ephemerides() {
  CorrectionServices services{CorrectionOptions{}};
  services.add_stream(kStream);
  for (const Walker& walker : {gps_walker(), galileo_walker()}) {
    for (const Ephemeris& e : walker_ephemerides(walker)) services.add(e);
  }
  return services;
}

// Its buffers are large. From one input to the next nothing stays in it but the counts of messages.
InputMessages* shared_messages() {
  static InputMessages messages;
  return &messages;
}

// What leonav-connect has around a format. What is always the same is made once and copied.
struct Surroundings {
  Surroundings() : clock(made_clock()) {}
  // For a format that takes corrections.
  void receive_ephemerides() {
    static const CorrectionServices made = services_with_ephemerides();
    shared.services = made;
  }
  static const GpsClock& made_clock() {
    static const GpsClock made = tied_clock();
    return made;
  }

  std::int64_t arrival_ns = kBegin_ns + 2'000'000'000;
  CheckedMessages messages;
  MessageOutput output{&messages, shared_messages()};
  SharedCorrections shared{CorrectionOptions{}, ServiceChoiceOptions{}, &output};
  CorrectionOutput corrections{kStream, &shared};
  GpsClock clock;
  PulseQueue pulses;
};

using Format = std::unique_ptr<StreamFormat>;
using Make = Format (*)(Surroundings* around, unsigned options);
using Repair = void (*)(std::vector<std::uint8_t>* bytes);

// Feeds pieces of 1 to 256 bytes, by turns of a generator that begins with `cut`; 0: all at once.
FormatCounts feed(StreamFormat* format, FuzzBytes bytes, std::uint32_t cut,
                  std::int64_t arrival_ns) {
  std::uint32_t state = cut;
  for (std::size_t i = 0; i < bytes.size();) {
    state = state * 1664525U + 1013904223U;
    const std::size_t length = cut == 0 ? bytes.size() : 1 + (state >> 24 & (cut | 3U));
    const FuzzBytes piece = bytes.subspan(i, std::min(length, bytes.size() - i));
    format->feed(piece, arrival_ns);
    arrival_ns += static_cast<std::int64_t>(piece.size()) * 87'000;  // 115200 baud
    i += piece.size();
  }
  format->finish();
  return format->counts();
}

// What the status shows must be told in any state.
void look(const StreamFormat& format) {
  const std::string text =
      joined({format.detail(), format.why_no_frames(), format.why_no_messages()});
  if (text.size() > 10'000) throw Finding("a status of " + std::to_string(text.size()) + " bytes");
  static_cast<void>(format.data_time());
  static_cast<void>(format.stamp_sigma_s());
}

// The first byte of an input chooses options, of which the highest bit leaves wrong checksums; the
// second one the pieces. One input in four is fed at once as well.
void run_format(FuzzBytes input, Make make, Repair repair) {
  ByteScript script(input);
  const unsigned options = script.byte();
  const std::uint32_t cut = script.byte();
  const FuzzBytes rest = script.rest();
  std::vector<std::uint8_t> bytes(rest.begin(), rest.end());
  if ((options & 0x80U) == 0) repair(&bytes);

  Surroundings around;
  const Format format = make(&around, options);
  look(*format);
  const FormatCounts in_pieces = feed(format.get(), bytes, cut, around.arrival_ns);
  look(*format);

  if (cut == 0 || !is_chosen(input, 4)) return;
  Surroundings others;
  const Format other = make(&others, options);
  const FormatCounts at_once = feed(other.get(), bytes, 0, others.arrival_ns);
  if (in_pieces.frames != at_once.frames) {
    throw Finding(std::to_string(in_pieces.frames) + " messages in pieces, " +
                  std::to_string(at_once.frames) + " at once");
  }
}

Format make_ubx(Surroundings* around, unsigned options) {
  around->receive_ephemerides();
  UbxStreamOptions own;
  own.is_inertial = (options & 1U) != 0;
  own.stamps.latency_s = 0.004;
  own.pulse_input.is_falling = (options & 2U) != 0;
  own.uses_pages = (options & 4U) == 0;
  return std::make_unique<UbxFormat>(kLatency_s, 30.0, &around->clock, &around->output,
                                     &around->corrections, own,
                                     (options & 8U) != 0 ? nullptr : &around->pulses);
}

// A day is given, because otherwise the host's clock would be asked.
Format make_rtcm3(Surroundings* around, unsigned options) {
  around->receive_ephemerides();
  return std::make_unique<Rtcm3Format>(kSkyEpoch, (options & 1U) != 0 ? 0.0 : 30.0, &around->clock,
                                       &around->output, false, &around->corrections);
}

Format make_rtcm3_service(Surroundings* around, unsigned) {
  around->receive_ephemerides();
  return std::make_unique<Rtcm3Format>(kSkyEpoch, 0.0, &around->clock, &around->output, true,
                                       &around->corrections);
}

Format make_oem7(Surroundings* around, unsigned options) {
  around->receive_ephemerides();
  Oem7StreamOptions own;
  own.is_inertial = (options & 1U) == 0;
  if ((options & 2U) != 0) own.imu_scale = ImuScale{1e-7, 1e-6};
  return std::make_unique<Oem7Format>(own, kLatency_s, 30.0, &around->clock, &around->output,
                                      &around->corrections);
}

Format make_sbf(Surroundings* around, unsigned options) {
  around->receive_ephemerides();
  const SbfStreamOptions own{(options & 1U) == 0, (options & 2U) == 0};
  return std::make_unique<SbfFormat>(own, kLatency_s, 30.0, &around->clock, &around->output,
                                     &around->corrections);
}

ImuStampOptions stamps_of(unsigned options) { return {0.004, (options & 1U) != 0 ? 100.0 : 0.0}; }

Format make_vectornav(Surroundings* around, unsigned options) {
  return std::make_unique<VectornavFormat>(&around->clock, stamps_of(options), &around->output,
                                           (options & 2U) != 0 ? &around->pulses : nullptr);
}

Format make_xsens(Surroundings* around, unsigned options) {
  return std::make_unique<XsensFormat>(&around->clock, stamps_of(options), &around->output,
                                       (options & 2U) != 0 ? &around->pulses : nullptr);
}

Format make_imu_line(Surroundings* around, unsigned options) {
  using enum LineColumn;
  LineLayout layout;
  layout.columns = {kClockMs, kGyroX, kGyroY, kGyroZ, kAccelX, kAccelY, kAccelZ};
  if ((options & 4U) != 0) layout.columns[0] = kSkip;
  if ((options & 8U) != 0) {
    layout.columns[0] = kGpsTowS;
    layout.columns.insert(layout.columns.begin(), kGpsWeek);
  }
  if ((options & 16U) != 0) {
    layout.are_increments = true;
    layout.columns.push_back(kIntervalS);
  }
  if ((options & 32U) != 0) {
    layout.prefix = "$IMU,";
    layout.has_checksum = true;
  }
  if ((options & 64U) != 0) layout.separator = ' ';
  layout.axes = {2, 1, -3};
  return std::make_unique<ImuLineFormat>(layout, &around->clock, stamps_of(options),
                                         &around->output);
}

Format make_has(Surroundings* around, unsigned) {
  around->receive_ephemerides();
  return std::make_unique<PageFormat>(PageService::kGalileoHas, &around->corrections);
}

Format make_b2b(Surroundings* around, unsigned) {
  around->receive_ephemerides();
  return std::make_unique<PageFormat>(PageService::kBeidouB2b, &around->corrections);
}

}  // namespace

std::vector<FuzzTarget> wire_targets() {
  return {
      {"ubx", [](FuzzBytes b) { run_format(b, make_ubx, repair_ubx); }},
      {"rtcm3", [](FuzzBytes b) { run_format(b, make_rtcm3, repair_rtcm3); }},
      {"rtcm3_service", [](FuzzBytes b) { run_format(b, make_rtcm3_service, repair_rtcm3); }},
      {"sbf", [](FuzzBytes b) { run_format(b, make_sbf, repair_sbf); }},
      {"oem7", [](FuzzBytes b) { run_format(b, make_oem7, repair_oem7); }},
      {"vectornav", [](FuzzBytes b) { run_format(b, make_vectornav, repair_vectornav); }},
      {"xsens", [](FuzzBytes b) { run_format(b, make_xsens, repair_xsens); }},
      {"imu_line", [](FuzzBytes b) { run_format(b, make_imu_line, repair_nmea_lines); }},
      {"has_pages", [](FuzzBytes b) { run_format(b, make_has, repair_page_lines); }},
      {"b2b_pages", [](FuzzBytes b) { run_format(b, make_b2b, repair_page_lines); }},
  };
}

}  // namespace leonav::test
