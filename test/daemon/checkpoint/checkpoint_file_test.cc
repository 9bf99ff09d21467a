// The checkpoint's file: round trip, damage, power cuts; and who keeps it up to date.
#include "daemon/checkpoint/checkpoint_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <thread>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "daemon/checkpoint/checkpoint_writer.h"
#include "daemon/config/load_config.h"
#include "support/catch.h"
#include "support/programs/parked_checkpoint.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;
using test::parked;
using test::write_file;

std::string load_error(const std::string& path) {
  try {
    load_checkpoint(path);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

// Waits, ten seconds at most.
template <typename Condition>
bool comes_true(Condition condition) {
  for (int i = 0; i < 1000 && !condition(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

}  // namespace

TEST_CASE("a checkpoint comes back from its file; where there is none, that is no error") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("checkpoint.yaml");
  CHECK_FALSE(load_checkpoint(path));
  const Checkpoint saved = parked();
  REQUIRE(save_checkpoint(path, saved).empty());
  CHECK_FALSE(std::filesystem::exists(path + ".tmp"));
  const auto loaded = load_checkpoint(path);
  REQUIRE(loaded);
  CHECK(std::abs(seconds_between(loaded->time, saved.time)) < 1e-5);
  CHECK(loaded->standing);
  CHECK((loaded->antenna_p_e - saved.antenna_p_e).norm() < 1e-4);
  CHECK(loaded->antenna_sigma == Approx(saved.antenna_sigma));
  CHECK(loaded->heading == Approx(saved.heading));
  CHECK(loaded->heading_sigma == Approx(saved.heading_sigma));
  CHECK((loaded->gyro_bias_b - saved.gyro_bias_b).norm() < 1e-12);
  CHECK(loaded->gyro_bias_sigma == Approx(saved.gyro_bias_sigma));
  CHECK(loaded->code_sigma_factor == saved.code_sigma_factor);
  CHECK(loaded->doppler_sigma_factor == saved.doppler_sigma_factor);
  REQUIRE(loaded->calibration);
  const Calibration& calibration = *loaded->calibration;
  const auto same = [](const auto& a, const auto& b) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(a.size()); ++i)
      if (!(std::abs(a.data()[i] - b.data()[i]) <= 1e-12)) return false;
    return true;
  };
  CHECK(same(calibration.mounting_rpy, saved.calibration->mounting_rpy));
  CHECK(same(calibration.accel_bias_b, saved.calibration->accel_bias_b));
  CHECK(same(calibration.accel_bias_sigma, saved.calibration->accel_bias_sigma));
  CHECK(same(calibration.gyro_scale, saved.calibration->gyro_scale));
  CHECK(same(calibration.gyro_scale_sigma, saved.calibration->gyro_scale_sigma));
  CHECK(same(calibration.accel_scale, saved.calibration->accel_scale));
  CHECK(same(calibration.accel_scale_sigma, saved.calibration->accel_scale_sigma));
  CHECK(same(calibration.constants, saved.calibration->constants));
  CHECK(same(calibration.constant_sigmas, saved.calibration->constant_sigmas));
  REQUIRE(remove_checkpoint(path).empty());
  CHECK_FALSE(load_checkpoint(path));
  CHECK(remove_checkpoint(path).empty());
}

TEST_CASE("a checkpoint's file that is damaged is an error that says where") {
  const test::TemporaryFile file("checkpoint.yaml", "");
  CHECK(load_error(file.path()) == file.path() + ": is damaged: empty");
  REQUIRE(save_checkpoint(file.path(), parked()).empty());
  const std::string good = test::text_of(file.path());
  // Cut anywhere it is never taken for another one; but for the last line end, it is an error.
  for (std::size_t size = 0; size + 1 < good.size(); ++size) {
    INFO(good.substr(0, size));
    write_file(file.path(), good.substr(0, size));
    CHECK_FALSE(load_error(file.path()).empty());
  }
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, text.find('\n', at) - at, to);
    write_file(file.path(), text);
    return load_error(file.path());
  };
  CHECK(with("heading_deg", "heading_deg: nan").find(":7: heading_deg: 'nan'") !=
        std::string::npos);
  CHECK(with("heading_deg", "heading_deg: 400").find(":7: heading_deg") != std::string::npos);
  CHECK(with("heading_deg", "").find("heading_deg is missing") != std::string::npos);
  CHECK(with("heading_deg", "heading_rad: 1").find("unknown key") != std::string::npos);
  CHECK(with("gps_week", "gps_week: -3").find("gps_week") != std::string::npos);
  CHECK(with("code_sigma_factor", "").empty());  // a file of an older version
  CHECK(with("code_sigma_factor", "code_sigma_factor: 200").find("code_sigma_factor") !=
        std::string::npos);
  for (const char* bad :
       {"heading_sigma_deg: 0", "heading_sigma_deg: 30", "antenna_p_e_m: [1, 2, 3]",
        "antenna_sigma_m: 0", "complete: false", "gyro_bias_sigma_deg_per_h: 0"}) {
    const std::string text = bad;
    CHECK(with(text.substr(0, text.find(':')), text).find("holds no place") != std::string::npos);
  }
  write_file(file.path(), std::string(300, '\xff'));
  CHECK_FALSE(load_error(file.path()).empty());
  write_file(file.path(), std::string(1 << 20, '['));
  CHECK(load_error(file.path()).find("too long") != std::string::npos);
  CHECK(load_error("/dev/zero").find("no ordinary file") != std::string::npos);
}

TEST_CASE("a checkpoint's file has all of its calibration, or none as in older versions") {
  const test::TemporaryFile file("checkpoint.yaml", "");
  Checkpoint without = parked();
  without.calibration.reset();
  REQUIRE(save_checkpoint(file.path(), without).empty());
  REQUIRE(load_checkpoint(file.path()));
  CHECK_FALSE(load_checkpoint(file.path())->calibration);
  const std::string old = test::text_of(file.path());
  REQUIRE(save_checkpoint(file.path(), parked()).empty());
  const std::string good = test::text_of(file.path());
  const std::size_t begin = old.find("complete:");
  const std::size_t end = good.find("complete:");
  REQUIRE(old.substr(0, begin) == good.substr(0, begin));
  // Each line of it is needed, and none may hold nonsense.
  std::size_t lines = 0;
  for (std::size_t at = begin; at < end; ++lines) {
    const std::size_t next = good.find('\n', at) + 1;
    const std::string key = good.substr(at, good.find(':', at) - at);
    CAPTURE(key);
    write_file(file.path(), good.substr(0, at) + good.substr(next));
    CHECK(load_error(file.path()).find(key + " is missing") != std::string::npos);
    for (const char* bad : {"nan", "-.inf", "1e5", "[1e5, 0, 0]", "[0, 0, -9999]", "words"}) {
      write_file(file.path(), good.substr(0, at) + key + ": " + bad + "\n" + good.substr(next));
      CHECK_FALSE(load_error(file.path()).empty());
    }
    at = next;
  }
  CHECK(lines == 21);
}

TEST_CASE(
    "a power cut while a checkpoint is written leaves the old one, and does not stay in the way") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("checkpoint.yaml");
  REQUIRE(save_checkpoint(path, parked()).empty());
  const std::string old = test::text_of(path);
  write_file(path + ".tmp", old.substr(0, 40));  // what the cut left
  CHECK(load_checkpoint(path)->heading == Approx(-1.25));
  Checkpoint next = parked();
  next.heading = 2.0;
  REQUIRE(save_checkpoint(path, next).empty());
  CHECK(load_checkpoint(path)->heading == Approx(2.0));
  CHECK_FALSE(std::filesystem::exists(path + ".tmp"));
}

TEST_CASE("whenever a writer is killed, the file is a whole checkpoint") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("checkpoint.yaml");
  REQUIRE(save_checkpoint(path, parked()).empty());
  for (int round = 0; round < 50; ++round) {
    const pid_t writer = fork();
    REQUIRE(writer >= 0);
    if (writer == 0) {
      Checkpoint checkpoint = parked();
      for (;;) {
        checkpoint.heading = -checkpoint.heading;
        if (!save_checkpoint(path, checkpoint).empty()) _exit(1);
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(3000 + 137 * round));
    REQUIRE(kill(writer, SIGKILL) == 0);
    int status = 0;
    REQUIRE(waitpid(writer, &status, 0) == writer);
    CHECK(WIFSIGNALED(status));
    INFO(load_error(path));
    const auto left = load_checkpoint(path);
    REQUIRE(left);
    CHECK(std::abs(left->heading) == Approx(1.25));
  }
}

TEST_CASE("where nothing can be written the old checkpoint stays, and there is a reason") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("checkpoint.yaml");
  REQUIRE(save_checkpoint(path, parked()).empty());
  std::filesystem::create_directory(path + ".tmp");
  CHECK(save_checkpoint(path, parked()).find(path + ".tmp: cannot be made: ") == 0);
  CHECK(load_checkpoint(path));
  CHECK_FALSE(save_checkpoint(folder.beside("absent/checkpoint.yaml"), parked()).empty());
}

TEST_CASE("the file follows stops and starts at once, else the interval; the end is written") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("checkpoint.yaml");
  CheckpointWriter keeper({path, 3600.0});
  keeper.start();
  Checkpoint checkpoint = parked();
  keeper.latest()->set(checkpoint);
  CHECK(comes_true([&] { return std::filesystem::exists(path); }));
  checkpoint.heading = 1.0;
  checkpoint.standing = false;
  keeper.latest()->set(checkpoint);
  CHECK(comes_true([&] { return !load_checkpoint(path)->standing; }));
  checkpoint.heading = 2.0;
  keeper.latest()->set(checkpoint);
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  CHECK(load_checkpoint(path)->heading == Approx(1.0));  // the interval is not over
  keeper.finish();
  CHECK(load_checkpoint(path)->heading == Approx(2.0));
  CHECK(keeper.error().empty());
}

TEST_CASE("without a heading the file stays while the vehicle stands and goes when it moves") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("checkpoint.yaml");
  Checkpoint unsure = parked();
  unsure.heading_sigma = 1.0;
  for (const bool standing : {true, false}) {
    CAPTURE(standing);
    REQUIRE(save_checkpoint(path, parked()).empty());
    unsure.standing = standing;
    CheckpointWriter keeper({path, 10.0});
    keeper.start();
    keeper.latest()->set(unsure);
    keeper.finish();
    CHECK(std::filesystem::exists(path) == standing);
  }
}

TEST_CASE("a calibration that the next start would refuse is left out of the file") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("checkpoint.yaml");
  Checkpoint wild = parked();
  wild.calibration->accel_scale_sigma.x() = 7.0;
  CheckpointWriter keeper({path, 10.0});
  keeper.start();
  keeper.latest()->set(wild);
  keeper.finish();
  const auto left = load_checkpoint(path);
  REQUIRE(left);
  CHECK(left->heading == Approx(wild.heading));
  CHECK_FALSE(left->calibration);
}

TEST_CASE("what keeps a checkpoint from being written is reported") {
  const test::TemporaryFile folder("unused", "");
  CheckpointWriter keeper({folder.beside("absent/checkpoint.yaml"), 10.0});
  keeper.start();
  keeper.latest()->set(parked());
  CHECK(comes_true([&] { return !keeper.error().empty(); }));
  keeper.finish();
}

TEST_CASE("a disk that does not answer is told, and holds up no end") {
  const test::TemporaryFile folder("unused", "");
  // What the thread goes on using must live as long as the process.
  static std::mutex mutex;
  static std::condition_variable changed;
  static bool is_free = false;
  const auto wait = [] {
    std::unique_lock lock(mutex);
    changed.wait(lock, [] { return is_free; });
  };
  {
    CheckpointWriter keeper({folder.beside("checkpoint.yaml"), 10.0}, wait);
    keeper.start();
    keeper.latest()->set(parked());
    CHECK(comes_true([&] { return keeper.error().find("does not answer") != std::string::npos; }));
    const auto begin = std::chrono::steady_clock::now();
    keeper.finish();
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));
    CHECK_FALSE(std::filesystem::exists(folder.beside("checkpoint.yaml")));
  }
  {
    const std::lock_guard lock(mutex);
    is_free = true;
  }
  changed.notify_all();
  // The thread that was left to itself goes on.
  CHECK(comes_true([&] { return std::filesystem::exists(folder.beside("checkpoint.yaml")); }));
}

TEST_CASE("the latest of many values is taken, once") {
  LatestValue<std::array<int, 64>> latest;
  std::array<int, 64> got{};
  CHECK_FALSE(latest.take(&got));
  constexpr int kMany = 200'000;
  std::thread writer([&] {
    std::array<int, 64> value{};
    for (int i = 1; i <= kMany; ++i) {
      value.fill(i);
      latest.set(value);
    }
  });
  int last = 0;
  while (last < kMany) {
    if (!latest.take(&got)) continue;
    const bool whole = std::count(got.begin(), got.end(), got[0]) == 64;
    if (!whole || got[0] <= last) break;
    last = got[0];
  }
  writer.join();
  CHECK(last == kMany);
  CHECK_FALSE(latest.take(&got));
}
