// Two runs of the engine, the second from the checkpoint of the first; the journal has it all.
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <span>
#include <thread>

#include "core/earth/rotation.h"
#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/engine/engine.h"
#include "daemon/engine/saved_inputs.h"
#include "engine_runs.h"
#include "support/held_disk.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;

// Half a minute of standing.
std::vector<test::Input> parked_messages() {
  test::SyntheticDriveOptions options = test::noisy_drive(30.0);
  options.standstill_s = 60.0;
  std::vector<test::Input> list;
  test::feed_messages(test::synthetic_drive(options), [&](Channel channel, ByteSpan bytes) {
    list.push_back({channel, test::Bytes(bytes.begin(), bytes.end())});
  });
  return list;
}

double parked_heading() {
  test::SyntheticDriveOptions options = test::noisy_drive(30.0);
  options.standstill_s = 60.0;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(options.start);
  const NavState state = test::SyntheticPath(options).state(0.0);
  return euler_from_rotation(C_ne * state.q_eb.toRotationMatrix()).yaw;
}

// As the daemon: the file's checkpoint first, then what LCM brings. False: there was no file.
bool run_engine(const DaemonConfig& config, const std::vector<test::Input>& list,
                test::Collector* outputs, EngineCounters** counters,
                std::unique_ptr<Engine>* engine) {
  *engine = std::make_unique<Engine>(config, outputs);
  (*engine)->start();
  std::optional<Checkpoint> checkpoint;
  if (!config.checkpoint.path.empty()) checkpoint = load_checkpoint(config.checkpoint.path);
  if (!config.checkpoint.path.empty()) {
    if (const auto products = load_products(products_path(config.checkpoint.path)))
      receive_saved(*products, engine->get());
  }
  if (checkpoint) receive_saved(*checkpoint, engine->get());
  for (const test::Input& input : list) {
    (*engine)->receive(input.channel, input.bytes, 1);
    while (!(*engine)->idle()) test::wait_a_moment();
  }
  REQUIRE((*engine)->finish());
  *counters = &(*engine)->counters();
  return checkpoint.has_value();
}

}  // namespace

TEST_CASE("a run from a checkpoint is aligned at once and replays from its journal bit for bit") {
  const Estimator estimator = GENERATE(Estimator::kEkf, Estimator::kSmoother);
  const std::vector<test::Input> list = parked_messages();
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.navigator.estimator = estimator;
  config.checkpoint.path = folder.beside("checkpoint.yaml");
  std::unique_ptr<Engine> engine;
  EngineCounters* counters = nullptr;

  // The first knows its heading from outside, and ends standing.
  DaemonConfig told = config;
  told.navigator.alignment.initial_heading = parked_heading();
  told.navigator.alignment.initial_heading_sigma = 0.02;
  test::Collector first;
  CHECK_FALSE(run_engine(told, list, &first, &counters, &engine));
  const auto left = load_checkpoint(config.checkpoint.path);
  REQUIRE(left);
  CHECK(left->standing);
  CHECK(left->calibration);
  CHECK(std::abs(wrap_to_pi(left->heading - parked_heading())) < 0.06);
  CHECK(left->time > test::kSkyEpoch.plus_seconds(28.0));

  // The same place half a minute later, told nothing: the stamps are the first's, so the checkpoint
  // is dated back instead.
  Checkpoint earlier = *left;
  earlier.time = left->time.plus_seconds(-3600.0);
  REQUIRE(save_checkpoint(config.checkpoint.path, earlier).empty());
  config.journal.path = folder.beside("run.journal");
  test::Collector live;
  REQUIRE(run_engine(config, list, &live, &counters, &engine));
  CHECK(counters->checkpoints_used.get() == 1);
  CHECK(counters->checkpoints_ignored.get() == 0);
  CHECK(counters->calibration_use.get() ==
        1 + static_cast<std::int64_t>(CheckpointUse::kCalibrationUsed));
  CHECK(counters->received[index_of(Channel::kCheckpoint)].get() == 1);
  for (const Gauge& rejected : counters->rejected) CHECK(rejected.get() == 0);
  CHECK(counters->source.get() == static_cast<std::int64_t>(estimator == Estimator::kSmoother
                                                                ? Source::kSmoother
                                                                : Source::kEkf));

  // Without the files: all is in the journal.
  const auto products = load_products(products_path(config.checkpoint.path));
  REQUIRE(products);
  std::filesystem::remove(config.checkpoint.path);
  const auto journaled = test::read_journal_inputs(config.journal.path);
  const std::size_t saved = products->ephemerides.size() + (products->ionosphere ? 1 : 0);
  REQUIRE(journaled.size() == list.size() + saved + 1);
  CHECK(journaled[saved].channel == Channel::kCheckpoint);
  REQUIRE(test::missed_epochs(live).empty());
  check_same(live, test::run_navigator(config.navigator, journaled, {}));
  const auto without = test::run_navigator(config.navigator, list, {});
  CHECK(without.groups[0] != live.groups[0]);  // it did count
}

TEST_CASE("an old or a hostile checkpoint is counted and changes nothing of the navigation") {
  const std::vector<test::Input> list = parked_messages();
  DaemonConfig config = test::drive_config();
  const auto live_with = [&](Checkpoint checkpoint, std::int64_t ignored, std::int64_t rejected) {
    test::Collector live;
    Engine engine(config, &live);
    engine.start();
    Encoder encoder;
    engine.receive(Channel::kCheckpoint, encoder.encode(checkpoint, 1), 1);
    for (const test::Input& input : list) {
      engine.receive(input.channel, input.bytes, 1);
      while (!engine.idle()) test::wait_a_moment();
    }
    REQUIRE(engine.finish());
    CHECK(engine.counters().checkpoints_used.get() == 0);
    CHECK(engine.counters().checkpoints_ignored.get() == ignored);
    CHECK(engine.counters().rejected[static_cast<std::size_t>(InputFault::kOutOfRange)].get() ==
          rejected);
    return live;
  };
  Checkpoint checkpoint;
  checkpoint.time = test::kSkyEpoch.plus_seconds(-40.0 * 86400.0);
  checkpoint.standing = true;
  const test::SyntheticPath path(test::noisy_drive(30.0));
  checkpoint.antenna_p_e = path.antenna_p_e(0.0);
  checkpoint.antenna_sigma = 1.0;
  checkpoint.heading_sigma = 0.01;
  checkpoint.gyro_bias_sigma = 1e-5;
  const auto old = live_with(checkpoint, 1, 0);
  checkpoint.heading_sigma = -1.0;
  const auto hostile = live_with(checkpoint, 0, 1);
  const auto without = test::run_navigator(config.navigator, list, {});
  CHECK(old.groups[0] == without.groups[0]);
  CHECK(hostile.groups[0] == without.groups[0]);
}

TEST_CASE("a start waits a second for the disk of the checkpoint, and nothing is read behind it") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.checkpoint.path = folder.beside("checkpoint.yaml");
  test::Collector first;
  std::unique_ptr<Engine> engine;
  EngineCounters* counters = nullptr;
  config.navigator.alignment.initial_heading = parked_heading();
  config.navigator.alignment.initial_heading_sigma = 0.02;
  run_engine(config, parked_messages(), &first, &counters, &engine);
  REQUIRE(load_checkpoint(config.checkpoint.path));

  const auto disk = std::make_shared<test::HeldDisk>();
  const auto has_read = std::make_shared<std::atomic<bool>>(false);
  test::Collector outputs;
  Engine late(config, &outputs);
  late.start();
  const Stopwatch watch;
  begin_from_saved(config.checkpoint.path, &late, [disk, has_read] {
    disk->wait();
    has_read->store(true);
  });
  CHECK(watch.nanoseconds() < 10 * kNanosecondsPerSecond);  // and not until the disk answers
  disk->answer();
  while (!has_read->load()) test::wait_a_moment();
  for (const Channel channel : {Channel::kCheckpoint, Channel::kEphemeris})
    CHECK(late.counters().received[index_of(channel)].get() == 0);
  CHECK(late.counters().checkpoints_ignored.get() == 1);

  // With a disk that answers both files are inputs.
  begin_from_saved(config.checkpoint.path, &late);
  CHECK(late.counters().received[index_of(Channel::kCheckpoint)].get() == 1);
  CHECK(late.counters().received[index_of(Channel::kEphemeris)].get() > 0);
  CHECK(late.finish());
}

TEST_CASE("without checkpoint.path nothing is written") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.navigator.alignment.initial_heading = 1.0;
  std::unique_ptr<Engine> engine;
  EngineCounters* counters = nullptr;
  test::Collector outputs;
  CHECK_FALSE(run_engine(config, parked_messages(), &outputs, &counters, &engine));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(folder.path()).parent_path()))
    ++files;
  CHECK(files == 1);
  CHECK(counters->checkpoints_used.get() + counters->checkpoints_ignored.get() == 0);
}

TEST_CASE("a run that is started again needs nobody to repeat the ephemerides") {
  std::vector<test::Input> with, without;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(20.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        with.push_back({channel, test::Bytes(bytes.begin(), bytes.end())});
                        if (channel != Channel::kEphemeris) without.push_back(with.back());
                      });
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.checkpoint.path = folder.beside("checkpoint.yaml");
  std::unique_ptr<Engine> engine;
  EngineCounters* counters = nullptr;
  const auto used = [&] {
    std::int64_t satellites = 0;
    for (const Gauge& of_system : counters->satellites_used) satellites += of_system.get();
    return satellites;
  };
  // Nobody has saved anything yet.
  test::Collector none, first, second;
  run_engine(config, without, &none, &counters, &engine);
  CHECK(used() == 0);
  CHECK_FALSE(load_products(products_path(config.checkpoint.path)));
  run_engine(config, with, &first, &counters, &engine);
  const std::int64_t satellites = used();
  CHECK(satellites > 4);
  REQUIRE(load_products(products_path(config.checkpoint.path)));
  run_engine(config, without, &second, &counters, &engine);
  CHECK(used() == satellites);
  CHECK(counters->lost[index_of(Channel::kEphemeris)].get() == 0);
}

TEST_CASE("biases of signals that a run has received are the next run's, and in its journal") {
  std::vector<test::Input> without;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(5.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        without.push_back({channel, test::Bytes(bytes.begin(), bytes.end())});
                      });
  std::vector<test::Input> with = without;
  SignalBias bias;
  bias.satellite = {System::kGps, 5};
  bias.code = {'1', 'C'};
  bias.kind = BiasKind::kBroadcastCode;
  bias.time = test::kSkyEpoch;
  bias.bias_m = 1.5;
  SignalBias later = bias;
  later.time = test::kSkyEpoch.plus_seconds(1.0);
  later.code = {'5', 'Q'};
  Encoder encoder;
  for (const SignalBias& one : {bias, later}) {
    const ByteSpan bytes = encoder.encode(std::span(&one, 1), 1);
    with.push_back({Channel::kBiases, test::Bytes(bytes.begin(), bytes.end())});
  }
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.checkpoint.path = folder.beside("checkpoint.yaml");
  std::unique_ptr<Engine> engine;
  EngineCounters* counters = nullptr;
  test::Collector first, second;
  run_engine(config, with, &first, &counters, &engine);
  const auto products = load_products(products_path(config.checkpoint.path));
  REQUIRE(products);
  REQUIRE(products->biases.size() == 2);
  CHECK(products->biases[1].time == later.time);

  config.journal.path = folder.beside("run.journal");
  run_engine(config, without, &second, &counters, &engine);
  CHECK(counters->received[index_of(Channel::kBiases)].get() == 2);  // of two times
  for (const Gauge& rejected : counters->rejected) CHECK(rejected.get() == 0);
  const auto journaled = test::read_journal_inputs(config.journal.path);
  CHECK(std::count_if(journaled.begin(), journaled.end(), [](const test::Input& input) {
          return input.channel == Channel::kBiases;
        }) == 2);
  check_same(second, test::run_navigator(config.navigator, journaled, {}));
}
