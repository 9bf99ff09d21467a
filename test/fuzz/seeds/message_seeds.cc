#include "core/navigator/interface/epoch_report.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/journal_marks.h"
#include "drivers/lcm/signed_command.h"
#include "support/programs/parked_checkpoint.h"
#include "support/sky/simulated_sky.h"
#include "test/fuzz/good_input.h"
#include "test/fuzz/seeds/seed_writer.h"

namespace leonav::test {
namespace {

class Messages {
 public:
  void add(Channel channel, ByteSpan bytes) {
    all_.push_back({static_cast<std::uint8_t>(index_of(channel)), {bytes.begin(), bytes.end()}});
  }
  const std::vector<SeedMessage>& all() const { return all_; }

 private:
  std::vector<SeedMessage> all_;
};

AntennaPattern pattern() {
  AntennaPattern one;
  one.satellite = {System::kGps, 5};
  one.band = '1';
  one.offset_m << 0.0, 0.0, 1.5;
  one.variation.angles = 3;
  one.variation.azimuths = 1;
  one.variation.angle_step = 0.1;
  one.variation.values = {0.001F, -0.002F, 0.003F};
  return one;
}

RawEpoch full_epoch(GpsTime time) {
  RawEpoch epoch = epoch_of(time, 6);
  for (SignalObservation& one : epoch.observations) {
    one.carrier_cycles = one.pseudorange_m / 0.19;
    one.doppler_hz = -1200.0;
    one.cn0_dbhz = 45.0;
    one.lock_time_s = 12.0;
  }
  return epoch;
}

void add_products(Encoder* encoder, Messages* to) {
  PreciseState precise;
  precise.satellite = {System::kGps, 5};
  precise.time = kSkyEpoch;
  precise.p_e << 2e7, 1e7, 1e7;
  const std::vector<PreciseState> states(2, precise);
  to->add(Channel::kOrbitClock, encoder->encode(states, 1));
  CorrectedState corrected;
  corrected.satellite = {System::kGalileo, 5};
  corrected.time = corrected.corrected_at = corrected.orbit_corrected_at = kSkyEpoch;
  corrected.p_e << 2e7, 1e7, 1e7;
  corrected.v_e << 100.0, 2000.0, -1000.0;
  corrected.sigma_m = 0.1;
  to->add(Channel::kCorrectedStates,
          encoder->encode(std::vector<CorrectedState>(2, corrected), {1, 2, 3}, 1));
  SignalBias bias;
  bias.satellite = {System::kBeidou, 20};
  bias.code = {'2', 'I'};
  bias.time = kSkyEpoch;
  bias.bias_m = 1.5;
  to->add(Channel::kBiases, encoder->encode(std::vector<SignalBias>(3, bias), 1));
  KlobucharModel ionosphere;
  ionosphere.alpha = {1.1e-8, 1.5e-8, -6e-8, -6e-8};
  ionosphere.beta = {9e4, 3e4, -1.3e5, -2.6e5};
  ionosphere.valid = true;
  to->add(Channel::kIonosphere, encoder->encode(ionosphere, kSkyEpoch, 1));
  to->add(Channel::kAntenna, encoder->encode(pattern(), kSkyEpoch, 1));
}

}  // namespace

std::vector<SeedMessage> seed_messages() {
  static Encoder encoder;
  Messages messages;
  add_products(&encoder, &messages);
  std::uint64_t sequence = 0;
  for (const Walker& walker : {gps_walker(), galileo_walker(), beidou_walker(), leo_walker()}) {
    const Ephemeris one = walker_ephemerides(walker).front();
    messages.add(Channel::kEphemeris, encoder.encode(one, ++sequence));
  }
  messages.add(Channel::kCheckpoint, encoder.encode(parked(), 1));
  messages.add(Channel::kCommand,
               encoder.encode({CommandKind::kSetHeading, 1.0, 0.1}, kSkyEpoch, 1));
  messages.add(Channel::kCommand, encoder.encode({CommandKind::kRestart, 0, 0}, kSkyEpoch, 2));
  for (int k = 1; k <= 12; ++k) {
    const GpsTime time = kSkyEpoch.plus_seconds(0.1 * k);
    const auto count = static_cast<std::uint64_t>(k);
    messages.add(Channel::kImu, encoder.encode(sample_until(time, 100'000'000), count));
    if (k % 4 == 0) {
      messages.add(Channel::kOdometer,
                   encoder.encode(OdometerIncrement{time, 100'000'000, 0.1}, count));
      messages.add(Channel::kGnssEpoch, encoder.encode(full_epoch(time), count));
    }
  }
  return messages.all();
}

void write_message_seeds(SeedWriter* writer) {
  Seed list;
  std::size_t number = 0;
  for (const SeedMessage& one : seed_messages()) {
    list.byte(one.channel).half(one.bytes.size()).add(one.bytes);
    // Of the repeated ones a few do.
    if (one.channel == index_of(Channel::kImu) && number > 12) continue;
    const std::string name(name_of(static_cast<Channel>(one.channel)));
    writer->write("decoder", name + "_" + std::to_string(number++),
                  Seed().byte(one.channel).add(one.bytes));
  }
  writer->write("dispatch", "drive", list);

  Encoder encoder;
  const auto write = [&](Channel channel, ByteSpan bytes) {
    writer->write("decoder", name_of(channel), Seed().byte(index_of(channel)).add(bytes));
  };
  write(Channel::kSolution, encoder.encode(Solution()));
  write(Channel::kEpoch, encoder.encode(EpochReport()));
  write(Channel::kDecision, encoder.encode(Decision()));
  write(Channel::kSmoother, encoder.encode(SmootherReport()));
  write(Channel::kPiece, encode_piece({17, 2, 40, RecordedOutputs::kThinned}));
  write(Channel::kRefused, encode_refused({Channel::kImu, InputFault::kNotSane, 3}, 1));
  write(Channel::kLost, encode_lost({2, 1}, 1));
  write(Channel::kCommandNonce, encode_command_nonce({}, 1));
  writer->write(
      "decoder", kSignedCommandChannel,
      Seed().byte(index_of(Channel::kCommandNonce)).add(encode_signed_command(SignedCommand())));
}

}  // namespace leonav::test
