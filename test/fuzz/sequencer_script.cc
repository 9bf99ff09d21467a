#include "test/fuzz/sequencer_script.h"

#include <array>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/navigator/interface/vehicle_defaults.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/good_input.h"
#include "tools/common/format.h"

namespace leonav::test {
namespace {

constexpr std::int64_t kUs = 1'000;
// A script ends with the step that reaches this many inputs, because longer ones take time.
constexpr std::int64_t kMostInputs = 2500, kMostInputsOfShort = 800;
constexpr std::size_t kMostSteps = 200;

// Amounts of time around which the rules of the Sequencer turn.
constexpr std::array<std::int64_t, 32> kAmounts = {0,
                                                   1,
                                                   kUs,
                                                   kMs,
                                                   2'500 * kUs,
                                                   5 * kMs,
                                                   10 * kMs,
                                                   20 * kMs,
                                                   60 * kMs,
                                                   100 * kMs,
                                                   150 * kMs,
                                                   200 * kMs,
                                                   200 * kMs + 1,
                                                   400 * kMs,
                                                   500 * kMs,
                                                   999 * kMs,
                                                   kSecond,
                                                   1'500 * kMs,
                                                   2 * kSecond,
                                                   2 * kSecond + 1,
                                                   3 * kSecond,
                                                   5 * kSecond,
                                                   9'900 * kMs,
                                                   10 * kSecond,
                                                   10 * kSecond + 1,
                                                   12 * kSecond,
                                                   30 * kSecond,
                                                   100 * kSecond,
                                                   3'600 * kSecond,
                                                   86'400 * kSecond,
                                                   604'800 * kSecond,
                                                   40'000'000 * kSecond};

// Bit 7: negative. Bit 6: a byte of milliseconds follows, which is added. Bit 5: the half.
std::int64_t amount(ByteScript* bytes) {
  const std::uint8_t code = bytes->byte();
  std::int64_t value = kAmounts[code & 31U];
  if ((code & 32U) != 0) value /= 2;
  if ((code & 64U) != 0) value += bytes->byte() * kMs;
  return (code & 128U) != 0 ? -value : value;
}

NavigatorConfig config_from(ByteScript* bytes) {
  NavigatorConfig config = default_navigator_config(VehicleConfig().kind);
  const unsigned first = bytes->byte(), second = bytes->byte();
  constexpr std::array<double, 4> kIntervals = {1.0, 0.1, 5.0, 0.05};
  constexpr std::array<double, 4> kAllowances = {0.5, 0.0, 2.0, 1.0};
  constexpr std::array<double, 4> kOffsets = {0.0, 0.013, -0.08, 1.0};
  config.realtime.epoch_interval_s = kIntervals[first & 3U];
  config.realtime.gnss_latency_allowance_s = kAllowances[first >> 2 & 3U];
  config.imu_time_offset_s = kOffsets[first >> 4 & 3U];
  config.vehicle.motion.constraints.odometer = (first & 64U) == 0;
  if ((first & 128U) != 0) config.estimator = Estimator::kSmoother;
  if ((second & 7U) == 7U) config.motion = MotionModel::kConstantVelocity;
  if ((second & 8U) != 0) config.vehicle.mounting_rpy << 0.1, -0.2, 3.0;
  return config;
}

ScriptStep step_from(ByteScript* bytes) {
  ScriptStep step;
  const std::uint8_t code = bytes->byte();
  step.action = static_cast<ScriptAction>(code % kScriptActions);
  step.choice = static_cast<std::uint8_t>(code / kScriptActions);
  switch (step.action) {
    case ScriptAction::kDrive:
      step.count = 1 + bytes->byte() % 4;
      break;
    case ScriptAction::kSamples:
    case ScriptAction::kOdometer:
      step.count = 1 + bytes->byte();
      step.offset_ns = amount(bytes);
      step.step_ns = amount(bytes);
      step.interval_ns = step.choice % 4 == 0 ? 5 * kMs : amount(bytes);
      break;
    case ScriptAction::kEpochs:
      step.count = 1 + bytes->byte() % 64;
      step.offset_ns = amount(bytes);
      step.step_ns = amount(bytes);
      break;
    case ScriptAction::kTwoStreams:
    case ScriptAction::kJitter:
      step.count = 1 + bytes->byte();
      step.offset_ns = amount(bytes);
      break;
    case ScriptAction::kCommand:
      break;
    case ScriptAction::kRefused:
    case ScriptAction::kRepeat:
      step.count = 1 + bytes->byte() % 40;
      break;
    default:
      step.count = 1 + bytes->byte() % 40;
      step.offset_ns = amount(bytes);
  }
  return step;
}

// About how many samples, epochs and increments a step is.
std::int64_t inputs_of(const ScriptStep& step, std::int64_t sample_interval_ns) {
  if (step.action == ScriptAction::kDrive) return step.count * (kSecond / sample_interval_ns + 50);
  return step.action == ScriptAction::kTwoStreams ? 2 * step.count : step.count;
}

// Feeds the steps one after the other.
class Player {
 public:
  Player(const SequencerScript& script, Sequencer* sequencer)
      : interval_ns_(static_cast<std::int64_t>(script.config.realtime.epoch_interval_s * 1e9)),
        sample_interval_ns_(script.sample_interval_ns),
        sequencer_(sequencer) {}

  void play(const ScriptStep& step);
  GpsTime now() const { return now_; }

 private:
  // Beyond the range of stamps it begins anew at the other end.
  static GpsTime moved(GpsTime from, std::int64_t first_ns, std::int64_t step_ns, std::int64_t k) {
    const auto sum = static_cast<std::uint64_t>(from.nanoseconds() + first_ns) +
                     static_cast<std::uint64_t>(step_ns) * static_cast<std::uint64_t>(k);
    return GpsTime::from_nanoseconds(static_cast<std::int64_t>(sum));
  }
  void sample(const ImuSample& one) { sequencer_->on_imu(last_sample_ = one); }
  void epoch(const RawEpoch& one) { sequencer_->on_raw_epoch(last_epoch_ = one); }
  void odometer(GpsTime time, std::int64_t interval_ns) {
    sequencer_->on_odometer({time, interval_ns, 0.1});
  }
  void wait(std::int64_t time_ns);
  void drive(std::int64_t seconds);
  void good_samples(const ScriptStep& step);
  void extreme_stamp(const ScriptStep& step);
  void wrong_sample(const ScriptStep& step, std::int64_t k);
  void wrong_epoch(const ScriptStep& step, std::int64_t k);
  void ephemeris(const ScriptStep& step, std::int64_t k);
  void command(std::uint8_t choice);
  void checkpoint(const ScriptStep& step);
  void products(const ScriptStep& step);

  static constexpr std::int64_t kLongestWay = 5 * 365 * 86'400 * kSecond;
  const GpsTime begin_ = GpsTime::from_week_and_tow(2200, 100'000.0);
  GpsTime now_ = begin_;
  std::int64_t interval_ns_, sample_interval_ns_;  // of epochs, of samples
  Sequencer* sequencer_;
  ImuSample last_sample_;
  RawEpoch last_epoch_;
  std::uint32_t noise_ = 1;
};

constexpr std::array<std::int64_t, 12> kExtremes = {0,
                                                    1,
                                                    -1,
                                                    INT64_MIN,
                                                    INT64_MAX,
                                                    kSecond,
                                                    INT64_MIN / 2,
                                                    INT64_MAX / 2,
                                                    3'786'912'000LL * kSecond,
                                                    3'786'912'000LL * kSecond - 1,
                                                    2'000'000'000LL * kSecond,
                                                    10 * kSecond};

void Player::wait(std::int64_t time_ns) {
  const GpsTime then = now_.plus_nanoseconds(time_ns);
  if (std::abs(nanoseconds_between(then, begin_)) <= kLongestWay) now_ = then;
}

void Player::drive(std::int64_t seconds) {
  for (const GpsTime end = now_.plus_nanoseconds(seconds * kSecond); now_ < end;) {
    const std::int64_t before = now_.nanoseconds() / interval_ns_;
    const std::int64_t odometer_before = now_.nanoseconds() / (20 * kMs);
    now_ = now_.plus_nanoseconds(sample_interval_ns_);
    sample(sample_until(now_, sample_interval_ns_));
    if (now_.nanoseconds() / (20 * kMs) != odometer_before) odometer(now_, 20 * kMs);
    if (now_.nanoseconds() / interval_ns_ != before) epoch(epoch_of(now_, 5));
  }
}

// kTwoStreams and kJitter.
void Player::good_samples(const ScriptStep& step) {
  for (std::int64_t k = 0; k < step.count; ++k) {
    now_ = now_.plus_nanoseconds(sample_interval_ns_);
    noise_ = noise_ * 1664525U + 1013904223U;
    const std::int64_t part = static_cast<std::int64_t>(noise_ >> 16) - 32'768;
    if (step.action == ScriptAction::kJitter) {
      sample(
          sample_until(now_.plus_nanoseconds(step.offset_ns / 32'768 * part), sample_interval_ns_));
    } else {
      sample(sample_until(now_, sample_interval_ns_));
      sample(sample_until(now_.plus_nanoseconds(step.offset_ns), sample_interval_ns_));
    }
  }
}

void Player::extreme_stamp(const ScriptStep& step) {
  const GpsTime time =
      GpsTime::from_nanoseconds(kExtremes[static_cast<std::size_t>(step.count) % 12]);
  switch (step.choice % 4) {
    case 0:
      return sample(sample_until(time));
    case 1:
      return epoch(epoch_of(time));
    case 2:
      return odometer(time, 20 * kMs);
    default:
      return epoch(epoch_of(time, 0));
  }
}

void Player::wrong_sample(const ScriptStep& step, std::int64_t k) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  ImuSample one = sample_until(moved(now_, step.offset_ns, 5 * kMs, k));
  switch (step.choice) {
    case 0:
      one.delta_theta_b.x() = kNotMeasured;
      break;
    case 1:
      one.delta_velocity_b.z() = kInfinite;
      break;
    case 2:
      one.interval_ns = 0;
      break;
    case 3:
      one.interval_ns = -5 * kMs;
      break;
    case 4:
      one.interval_ns = INT64_MAX;
      break;
    case 5:
      one.interval_ns = INT64_MIN;
      break;
    case 6:
      one.delta_theta_b.setZero();
      one.delta_velocity_b.setZero();
      break;
    case 7:
      one.delta_theta_b *= 1e6;  // in degrees, for instance
      break;
    case 8:
      one.delta_velocity_b /= 9.8;
      break;
    case 9:
      one.interval_ns = 1;
      one.delta_theta_b *= 1e-9;
      one.delta_velocity_b *= 1e-7;
      break;
    default:
      one.delta_velocity_b *= 1e300;
  }
  sample(one);
}

void Player::wrong_epoch(const ScriptStep& step, std::int64_t k) {
  RawEpoch one = epoch_of(moved(now_, step.offset_ns, interval_ns_, k), 8);
  SignalObservation& first = one.observations.front();
  switch (step.choice) {
    case 0:
      one.observations.clear();
      break;
    case 1:
      first.satellite.number = 0;
      break;
    case 2:
      first.satellite.system = static_cast<System>(77);
      break;
    case 3:
      first.code = {'?', '\0'};
      break;
    case 4:
      for (auto& each : one.observations) each = first;
      break;
    case 5:
      first.pseudorange_m = 1e300;
      break;
    case 6:
      for (auto& each : one.observations) each.carrier_cycles = -1e300;
      break;
    case 7:
      one = epoch_of(one.time, one.observations.capacity());
      break;
    default:
      std::swap(one.observations.front(), one.observations.back());
  }
  epoch(one);
}

void Player::ephemeris(const ScriptStep& step, std::int64_t k) {
  Ephemeris one;
  one.satellite = {step.choice % 2 == 0 ? System::kGps : System::kGalileo,
                   static_cast<std::uint16_t>(1 + k % 30)};
  if (step.choice % 2 != 0) one.message = NavigationMessage::kGalileoInav;
  one.toe = one.toc = moved(now_, step.offset_ns, kSecond, k);
  one.sqrt_a = step.choice < 8 ? 5153.6 : 1e9;
  one.eccentricity = step.choice < 12 ? 0.01 : kNotMeasured;
  sequencer_->on_ephemeris(one);
}

void Player::command(std::uint8_t choice) {
  switch (choice) {
    case 0:
      return sequencer_->on_command({CommandKind::kRestart, 0.0, 0.0});
    case 1:
      return sequencer_->on_command({CommandKind::kSetHeading, 1.0, 0.1});
    case 2:
      return sequencer_->on_command({CommandKind::kSetHeading, kNotMeasured, -1.0});
    case 3:
      return sequencer_->on_command({CommandKind::kRestart, 1e300, kNotMeasured});
    default:
      return sequencer_->on_command({static_cast<CommandKind>(choice), 0.0, 0.0});
  }
}

void Player::checkpoint(const ScriptStep& step) {
  Checkpoint one;
  one.time = moved(now_, step.offset_ns, 0, 0);
  one.standing = step.choice % 2 != 0;
  one.antenna_p_e << 4.2e6, 6e5, 4.7e6;
  one.antenna_sigma = 1.0;
  one.heading = step.choice < 8 ? 1.0 : 100.0;
  one.heading_sigma = 0.01;
  one.gyro_bias_sigma = step.choice < 12 ? 1e-4 : kNotMeasured;
  if (step.choice % 3 == 0) {
    Calibration& calibration = one.calibration.emplace();
    calibration.accel_bias_b.setConstant(step.choice < 8 ? 0.1 : 1e300);
    calibration.constant_sigmas.fill(step.choice < 12 ? 0.01 : kNotMeasured);
  }
  sequencer_->on_checkpoint(one);
}

void Player::products(const ScriptStep& step) {
  const GpsTime time = moved(now_, step.offset_ns, 0, 0);
  const SatelliteId satellite{System::kGps, step.choice};
  switch (step.choice % 5) {
    case 0: {
      PreciseState state;
      state.satellite = satellite;
      state.time = time;
      state.p_e << 2e7, 1e7, 1e7;
      return sequencer_->on_precise_states(
          PreciseStates(static_cast<std::size_t>(step.count), state));
    }
    case 1: {
      CorrectedState state;
      state.satellite = satellite;
      state.time = state.corrected_at = state.orbit_corrected_at = time;
      state.p_e << 2e7, 1e7, 1e7;
      return sequencer_->on_corrected_states(
          CorrectedStates(static_cast<std::size_t>(step.count), state));
    }
    case 2: {
      SignalBias bias;
      bias.satellite = satellite;
      bias.code = {'1', 'C'};
      bias.time = time;
      return sequencer_->on_signal_biases(SignalBiases(static_cast<std::size_t>(step.count), bias));
    }
    case 3:
      return sequencer_->on_klobuchar({{1e-8, 0, 0, 0}, {1e5, 0, 0, 0}, step.choice < 8});
    default: {
      AntennaPattern pattern;
      pattern.satellite = satellite;
      pattern.band = '1';
      return sequencer_->on_antenna(pattern);
    }
  }
}

void Player::play(const ScriptStep& step) {
  const auto each = [&](auto feed) {
    for (std::int64_t k = 0; k < step.count; ++k) feed(k);
  };
  switch (step.action) {
    case ScriptAction::kDrive:
      return drive(step.count);
    case ScriptAction::kSamples:
      return each([&](std::int64_t k) {
        sample(sample_until(moved(now_, step.offset_ns, step.step_ns, k), step.interval_ns));
      });
    case ScriptAction::kEpochs:
      return each([&](std::int64_t k) {
        epoch(epoch_of(moved(now_, step.offset_ns, step.step_ns, k), step.choice));
      });
    case ScriptAction::kOdometer:
      return each([&](std::int64_t k) {
        odometer(moved(now_, step.offset_ns, step.step_ns, k), step.interval_ns);
      });
    case ScriptAction::kWait:
      return wait(step.offset_ns);
    case ScriptAction::kTwoStreams:
    case ScriptAction::kJitter:
      return good_samples(step);
    case ScriptAction::kExtremeStamp:
      return extreme_stamp(step);
    case ScriptAction::kWrongSamples:
      return each([&](std::int64_t k) { wrong_sample(step, k); });
    case ScriptAction::kWrongEpochs:
      return each([&](std::int64_t k) { wrong_epoch(step, k); });
    case ScriptAction::kEphemerides:
      return each([&](std::int64_t k) { ephemeris(step, k); });
    case ScriptAction::kCommand:
      return command(step.choice);
    case ScriptAction::kCheckpoint:
      return checkpoint(step);
    case ScriptAction::kRefused:
      if (step.choice < 8) return sequencer_->on_rejected(static_cast<InputFault>(step.count));
      return sequencer_->on_refused(static_cast<InputFault>(step.choice),
                                    static_cast<std::uint64_t>(step.count));
    case ScriptAction::kProducts:
      return products(step);
    case ScriptAction::kRepeat:
      return each([&](std::int64_t) {
        if (step.choice % 2 == 0) sequencer_->on_imu(last_sample_);
        if (step.choice % 2 != 0) sequencer_->on_raw_epoch(last_epoch_);
      });
  }
}

constexpr std::array<const char*, kScriptActions> kNames = {
    "drive s",       "samples",       "epochs",       "odometer",    "wait",    "two streams",
    "extreme stamp", "wrong samples", "wrong epochs", "ephemerides", "command", "checkpoint",
    "refused",       "products",      "repeat",       "jitter"};

}  // namespace

SequencerScript script_from(FuzzBytes bytes, bool is_whole) {
  ByteScript rest(bytes);
  SequencerScript script;
  script.config = config_from(&rest);
  script.sample_interval_ns = is_whole ? 5 * kMs : 20 * kMs;
  const std::int64_t most_inputs = is_whole ? kMostInputs : kMostInputsOfShort;
  for (std::int64_t inputs = 0;
       !rest.empty() && script.steps.size() < kMostSteps && inputs < most_inputs;) {
    script.steps.push_back(step_from(&rest));
    inputs += inputs_of(script.steps.back(), script.sample_interval_ns);
  }
  return script;
}

std::string text_of(const SequencerScript& script) {
  const NavigatorConfig& c = script.config;
  std::string text = format(
      "epochs each %g s, samples each %g s, latency %g s, IMU offset %g s, odometer %d, %s, %s\n",
      c.realtime.epoch_interval_s, static_cast<double>(script.sample_interval_ns) * 1e-9,
      c.realtime.gnss_latency_allowance_s, c.imu_time_offset_s,
      c.vehicle.motion.constraints.odometer,
      c.motion == MotionModel::kInertial ? "inertial" : "no IMU",
      c.estimator == Estimator::kSmoother ? "smoother" : "filter");
  for (const ScriptStep& s : script.steps) {
    text += format("%s: %lld from %+.9f s each %+.9f s, interval %.9f s, choice %d\n",
                   kNames[static_cast<std::size_t>(s.action)], static_cast<long long>(s.count),
                   static_cast<double>(s.offset_ns) * 1e-9, static_cast<double>(s.step_ns) * 1e-9,
                   static_cast<double>(s.interval_ns) * 1e-9, s.choice);
  }
  return text;
}

GpsTime play(const SequencerScript& script, Sequencer* sequencer) {
  Player player(script, sequencer);
  for (const ScriptStep& step : script.steps) player.play(step);
  return player.now();
}

}  // namespace leonav::test
