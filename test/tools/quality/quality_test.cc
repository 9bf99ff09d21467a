// The whole analysis on a synthetic log of which everything is known.
#include "tools/quality/quality.h"

#include <cmath>
#include <map>
#include <set>

#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/sky/simulated_sky.h"
#include "support/temporary_file.h"

using namespace leonav;
using namespace leonav::test;

namespace {

constexpr int kEpochs = 240;
constexpr int kHole = 200, kHoleEpochs = 5;  // too short to end an arc
const SignalCode kFirst{'1', 'C'}, kSecond{'2', 'W'};

double multipath_m(SatelliteId satellite, SignalCode code, int k) {
  const double amplitude_m = code == kFirst ? 0.5 : 0.8;
  return amplitude_m * std::sin(0.11 * k + satellite.number + (code == kFirst ? 0.0 : 1.0));
}

struct Slip {
  int epoch;
  double first, second;  // cycles
  bool told;
};

// GPS on two frequencies, Galileo on E1 alone; one GPS satellite without ephemeris.
struct SyntheticLog {
  SimulatedSky sky;
  SimulatedReceiver receiver;
  std::map<SatelliteId, Slip> slips;
  SatelliteId without_ephemeris;
  TemporaryFile file{"run.lcmlog", ""};

  SyntheticLog() {
    sky.add(gps_walker());
    sky.add(galileo_walker());
    std::vector<SatelliteId> high;
    for (const Ephemeris& e : sky.ephemerides) {
      if (e.satellite.system == System::kGps && simulated_elevation(receiver, e, 0.0) > 0.4)
        high.push_back(e.satellite);
    }
    REQUIRE(high.size() >= 5);
    slips[high[0]] = {80, 3.0, 0.0, false};
    slips[high[1]] = {120, 1.0, 1.0, false};
    slips[high[2]] = {160, 10.0, -4.0, true};
    without_ephemeris = high[3];
    write();
  }

  RawEpoch epoch(int k) const {
    RawEpoch raw = simulate_epoch(sky, receiver, k);
    for (std::size_t i = 0; i < raw.observations.size(); ++i) {
      SignalObservation& o = raw.observations[i];
      const auto slip = slips.find(o.satellite);
      const bool slipped = slip != slips.end() && k >= slip->second.epoch;
      const bool first = o.code == kFirst;
      double ionosphere_m = 0.0;  // of this signal; without a second one it stays in the carrier
      if (o.satellite.system == System::kGps) {
        // Codes of the pair: the first of them has its multipath already when the second comes.
        const double gamma = std::pow(1575.42 / 1227.60, 2);
        const double p1 = first ? o.pseudorange_m : clean_first_;
        const double p2 = first ? raw.observations[i + 1].pseudorange_m : o.pseudorange_m;
        if (first) clean_first_ = p1;
        ionosphere_m = (p2 - p1) / (gamma - 1.0) * (first ? 1.0 : gamma);
      }
      const double bias = 1000.0 * o.satellite.number + (first ? 17.0 : -33.0) +
                          (slipped ? (first ? slip->second.first : slip->second.second) : 0.0);
      o.carrier_cycles =
          (o.pseudorange_m - 2.0 * ionosphere_m) / wavelength_m(o.satellite.system, o.code.band) +
          bias;
      o.loss_of_lock = slipped && slip->second.told && k == slip->second.epoch && first;
      o.pseudorange_m += multipath_m(o.satellite, o.code, k);
      o.cn0_dbhz = first ? 48.0 : 41.5;
    }
    return raw;
  }

  void write() {
    EventLogWriter log(file.path());
    Encoder encoder;
    std::uint64_t n = 0;
    for (const Ephemeris& e : sky.ephemerides) {
      if (e.satellite == without_ephemeris) continue;
      REQUIRE(log.write(1, "LEONAV_EPHEMERIS", encoder.encode(e, ++n)));
    }
    REQUIRE(log.write(2, "SOMETHING_ELSE", std::vector<std::uint8_t>{1, 2, 3}));
    n = 0;
    for (int k = 0; k < kEpochs; ++k) {
      if (k >= kHole && k < kHole + kHoleEpochs) continue;
      REQUIRE(log.write(3 + k, "LEONAV_GNSS_EPOCH", encoder.encode(epoch(k), ++n)));
      if (k == 50)
        REQUIRE(log.write(3 + k, "LEONAV_GNSS_EPOCH", std::vector<std::uint8_t>{9, 9, 9}));
    }
    REQUIRE(log.flush());
  }

 private:
  mutable double clean_first_ = 0.0;
};

// Of the injected multipath, each arc about its mean.
double expected_rms_m(const SyntheticLog& log, SatelliteId satellite, SignalCode code) {
  double squares = 0.0, count = 0.0;
  const auto slip = log.slips.find(satellite);
  const int cut = slip == log.slips.end() ? kEpochs : slip->second.epoch;
  for (const auto& [begin, end] : {std::pair(0, cut), std::pair(cut, kEpochs)}) {
    std::vector<double> values;
    for (int k = begin; k < end; ++k) {
      if (k >= kHole && k < kHole + kHoleEpochs) continue;
      values.push_back(multipath_m(satellite, code, k));
    }
    if (values.empty()) continue;
    double mean = 0.0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    const auto n = static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean) * n / (n - 1.0);
    count += n;
  }
  return std::sqrt(squares / count);
}

}  // namespace

TEST_CASE("quality of a log of which everything is known") {
  const SyntheticLog log;
  QualityOptions options;
  options.plot_epochs = 1000;
  const Quality quality = analyse_quality(log.file.path(), options, nullptr);

  CHECK(quality.times.epochs == kEpochs - kHoleEpochs);
  CHECK(quality.times.interval_s == 1.0);
  CHECK(quality.times.gaps == 1);
  CHECK(quality.times.missing == kHoleEpochs);
  CHECK(quality.inputs.refused_epochs == 1);
  CHECK(quality.solved_epochs == quality.times.epochs);
  CHECK(quality.clock_jumps == 0);
  CHECK(quality.code_steps == 0);

  SECTION("multipath is what was put in, about the mean of each arc") {
    int judged = 0;
    for (const auto& [id, satellite] : quality.satellites) {
      if (id.system != System::kGps || satellite.epochs != quality.times.epochs) continue;
      for (const SignalCode code : {kFirst, kSecond}) {
        CAPTURE(to_string(id), to_string(code));
        const MultipathSum sum = satellite.signals.at(code).multipath.all();
        CHECK(sum.rms_m() == Approx(expected_rms_m(log, id, code)).epsilon(1e-3));
        CHECK(sum.samples == quality.times.epochs);
        ++judged;
      }
    }
    CHECK(judged >= 10);
  }
  SECTION("the slips are these and no other") {
    std::map<SatelliteId, GpsTime> found;
    for (const ArcBreak& one : quality.breaks) {
      CAPTURE(to_string(one.satellite), one.causes.bits());
      if (one.causes == SlipCauses(SlipCause::kUntested)) {  // low, and on one frequency
        CHECK_FALSE(is_slip(one.causes));
        CHECK(one.elevation < 0.2);
        continue;
      }
      CHECK(is_slip(one.causes));
      CHECK(log.slips.count(one.satellite) == 1);
      CHECK(found.count(one.satellite) == 0);
      CHECK(one.elevation > 0.35);
      found[one.satellite] = one.time;
      CHECK(is_flagged_by_receiver(one.causes) == log.slips.at(one.satellite).told);
    }
    REQUIRE(found.size() == log.slips.size());
    for (const auto& [id, slip] : log.slips)
      CHECK(found.at(id) == kSkyEpoch.plus_seconds(slip.epoch));
    const auto& flagged = quality.signals.at({System::kGps, kFirst});
    CHECK(flagged.loss_of_lock == 1);
  }
  SECTION("C/N0, single frequency and a satellite without orbit are told") {
    const auto& first = quality.signals.at({System::kGps, kFirst});
    CHECK(first.cn0_all().mean() == Approx(48.0));
    CHECK(first.cn0_all().percentile(0.05) == Approx(48.0));
    for (const auto& [id, satellite] : quality.satellites) {
      CHECK(satellite.one_frequency == (id.system == System::kGalileo));
      if (id.system == System::kGalileo)
        CHECK(satellite.signals.at(kFirst).without_carriers == satellite.epochs);
    }
    const SatelliteQuality& lost = quality.satellites.at(log.without_ephemeris);
    CHECK(lost.usable_epochs == 0);
    CHECK(lost.reasons.at(Reason::kNoEphemeris) == quality.times.epochs);
    CHECK(std::isnan(lost.highest_elevation));
    CHECK(to_table(quality).find(to_string(log.without_ephemeris) + "  no_ephemeris") !=
          std::string::npos);
    // Its multipath is known, its elevation is not.
    CHECK(lost.signals.at(kFirst).multipath.bins[kNoElevation].samples == quality.times.epochs);
  }
  SECTION("rows for plots: every epoch, multipath without its level") {
    CHECK(quality.plot_epochs.size() == quality.times.epochs);
    for (const SignalSample& sample : quality.plot_samples) {
      if (sample.satellite.system == System::kGps) CHECK(std::abs(sample.multipath_m) < 1.7F);
    }
  }
}

TEST_CASE("plot rows of long logs are thinned, the numbers are not") {
  const SyntheticLog log;
  QualityOptions options;
  options.plot_epochs = 50;
  const Quality quality = analyse_quality(log.file.path(), options, nullptr);
  CHECK(quality.plot_epochs.size() <= 50);
  CHECK(quality.plot_epochs.size() > 40);
  CHECK(quality.signals.at({System::kGps, kFirst}).codes > 7 * quality.times.epochs);
}

TEST_CASE("leonav-eval --quality: table, JSON, plots; bad logs are named") {
  if (!have_programs("leonav-eval", "leonav-quality-plots")) return;
  const SyntheticLog log;
  const std::string folder = log.file.beside("plots"), json = log.file.beside("q.json");
  const ProgramRun run = run_program("leonav-eval", "--quality --json '" + json + "' --plots '" +
                                                        folder + "' '" + log.file.path() + "'");
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(run.out.find("235 epochs at 1 s, 5 missing in 1 gaps (longest 6.0 s)") !=
        std::string::npos);
  CHECK(text_of(json).find("\"slip_totals\"") != std::string::npos);
  for (const char* name : {"sky.png", "satellites.png", "multipath.png", "cn0.png", "slips.png",
                           "index.html", "epochs.csv", "signals.csv", "slips.csv"}) {
    CHECK(std::filesystem::file_size(folder + "/" + name) > 100);
  }

  const auto fails = [](const std::string& words, const std::string& message, int code = 1) {
    const ProgramRun bad = run_program("leonav-eval", "--quality " + words);
    CAPTURE(words, bad.err);
    CHECK(bad.exit_code == code);
    CHECK(bad.err.find(message) != std::string::npos);
  };
  const TemporaryFile empty("empty.lcmlog", ""), text("text.lcmlog", "no log at all, but text");
  fails("'" + empty.path() + "'", "is empty");
  fails("'" + text.path() + "'", "is not an LCM log");
  fails("absent.lcmlog", "cannot be opened");
  fails("'" + log.file.path() + "' --truth x.csv", "--truth judges solutions", 2);
  fails("'" + log.file.path() + "' --mask 95", "--mask must be", 2);
  fails("", "takes one log", 2);
  fails("--prefix OTHER_ '" + log.file.path() + "'", "give --prefix LEONAV_");
}

// One damaged time: at the beginning, in the middle, ahead by a year or behind.
TEST_CASE("an epoch with a wrong time is left out and takes no other with it") {
  const SyntheticLog log;
  for (const auto& [place, offset_s] : std::vector<std::pair<int, double>>{
           {0, 3.0e7}, {100, 3.0e7}, {100, 50.0}, {100, -3.0e7}, {0, -3.0e7}}) {
    CAPTURE(place, offset_s);
    const TemporaryFile file("run.lcmlog", "");
    {
      EventLogWriter writer(file.path());
      Encoder encoder;
      std::uint64_t n = 0;
      for (const Ephemeris& e : log.sky.ephemerides)
        REQUIRE(writer.write(1, "LEONAV_EPHEMERIS", encoder.encode(e, ++n)));
      for (int k = 0; k < 150; ++k) {
        RawEpoch raw = log.epoch(k);
        if (k == place) raw.time = raw.time.plus_seconds(offset_s);
        REQUIRE(writer.write(2 + k, "LEONAV_GNSS_EPOCH", encoder.encode(raw, ++n)));
      }
    }
    const Quality quality = analyse_quality(file.path(), {}, nullptr);
    const bool early_start = place == 0 && offset_s < 0.0;  // cannot be told from a long gap
    CHECK(quality.times.epochs == (early_start ? 150 : 149));
    CHECK(quality.times.backwards == (early_start ? 0 : 1));
  }
}

TEST_CASE("a log cut short or damaged is judged up to there, and says so") {
  const SyntheticLog log;
  const std::string bytes = text_of(log.file.path());
  const TemporaryFile cut("cut.lcmlog", std::string_view(bytes).substr(0, bytes.size() - 100));
  CHECK(analyse_quality(cut.path(), {}, nullptr).inputs.truncated);

  std::string broken = bytes;
  const std::size_t middle = bytes.find("LEONAV_GNSS_EPOCH", bytes.size() / 2) - 28;
  broken.replace(middle, 4, "XXXX");
  const TemporaryFile damaged("damaged.lcmlog", broken);
  const Quality quality = analyse_quality(damaged.path(), {}, nullptr);
  CHECK(quality.times.epochs > 50);
  CHECK(quality.times.epochs < 200);
  CHECK(quality.inputs.damage.find("byte " + std::to_string(middle)) != std::string::npos);
  CHECK(to_table(quality).find("what follows is not judged") != std::string::npos);

  const std::size_t first_epoch = bytes.find("LEONAV_GNSS_EPOCH") - 28;
  const TemporaryFile none("none.lcmlog", std::string_view(bytes).substr(0, first_epoch));
  CHECK_THROWS_WITH(analyse_quality(none.path(), {}, nullptr),
                    Catch::Matchers::Contains("holds no GNSS epoch"));
}
