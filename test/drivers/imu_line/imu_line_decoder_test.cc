// Lines of text from an inertial sensor, good and damaged.
#include "drivers/imu_line/imu_line_decoder.h"

#include <numbers>

#include "support/catch.h"

namespace leonav {
namespace {

class LineCollector : public ImuLineHandler {
 public:
  void on_line(const ImuLine& line) override { lines.push_back(line); }
  std::vector<ImuLine> lines;
};

LineLayout layout() {
  using enum LineColumn;
  LineLayout layout;
  layout.columns = {kClockMs, kGyroX, kGyroY, kGyroZ, kSkip, kAccelX, kAccelY, kAccelZ};
  layout.gyro_unit = std::numbers::pi / 180.0;
  layout.accel_unit = 9.80665;
  return layout;
}

LineCollector decode(const LineLayout& how, const std::string& text,
                     ImuLineCounters* counters = nullptr) {
  ImuLineDecoder decoder(how);
  LineCollector collector;
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    decoder.feed({&byte, 1}, &collector);
  }
  if (counters != nullptr) *counters = decoder.counters();
  return collector;
}

}  // namespace

TEST_CASE("A line becomes SI units in the vehicle's axes", "[imu_line]") {
  LineLayout how = layout();
  how.axes = {2, 1, -3};  // forward is y, right is x, down is against z
  const auto lines = decode(how, "12.5, 1,2,3, ignored, 0.1,0.2,1.0\r\n").lines;
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].clock_ns == 12'500'000);
  CHECK(lines[0].gyro[0] == Approx(2.0 * std::numbers::pi / 180.0));
  CHECK(lines[0].gyro[2] == Approx(-3.0 * std::numbers::pi / 180.0));
  CHECK(lines[0].accel[1] == Approx(0.1 * 9.80665));
  CHECK(lines[0].accel[2] == Approx(-9.80665));
  CHECK_FALSE(lines[0].gps_time);
}

TEST_CASE("A damaged line costs itself only, with its reason", "[imu_line]") {
  ImuLineCounters counters;
  const std::string good = "1,0,0,0,x,0,0,-1\n";
  const std::string text = good + "1,0,0,0,x,0,0\n" + "1,0,nan,0,x,0,0,-1\n" +
                           "1,99999,0,0,x,0,0,-1\n" + std::string(5000, 'a') + "\n" + good +
                           std::string("1,0,\0", 5) + "\n" + good + "1,0,0";
  CHECK(decode(layout(), text, &counters).lines.size() == 3);
  CHECK(counters.lines == 3);
  CHECK(counters.bad_columns == 2);
  CHECK(counters.bad_values == 2);
  CHECK(counters.too_long == 1);
}

TEST_CASE("A clock that begins again at zero goes on", "[imu_line]") {
  LineLayout how = layout();
  how.columns[0] = LineColumn::kClockUs;
  const auto clocks = [&how](const std::vector<std::string>& values) {
    std::string text;
    for (const std::string& value : values) text += value + ",0,0,0,x,0,0,-1\n";
    std::vector<std::int64_t> found;
    for (const ImuLine& line : decode(how, text).lines) found.push_back(*line.clock_ns);
    return found;
  };
  using Clocks = std::vector<std::int64_t>;
  // micros() of 32 bits, twice around.
  const std::int64_t range_ns = 1000 * (std::int64_t{1} << 32);
  CHECK(clocks({"4294957296", "4704", "2147483648", "4294957296", "4704", "14704"}) ==
        Clocks{range_ns - 10'000'000, range_ns + 4'704'000, range_ns + range_ns / 2,
               2 * range_ns - 10'000'000, 2 * range_ns + 4'704'000, 2 * range_ns + 14'704'000});
  // A line that has lost digits on the way is no end of the counter.
  CHECK(clocks({"4294937296", "4294947", "4294957296"}).back() == range_ns - 10'000'000);
  // A clock that counts on, and one of fewer bits.
  CHECK(clocks({"4294957296", "4294972000", "4294982000"}).back() == 4'294'982'000'000);
  how.clock_bits = 16;
  CHECK(clocks({"65000", "464"}) == Clocks{65'000'000, 66'000'000});
}

TEST_CASE("The clock of a line that is refused neither makes nor hides an end of the counter",
          "[imu_line]") {
  using enum LineColumn;
  LineLayout how;
  how.columns = {kClockUs, kGyroX, kGyroY, kGyroZ, kAccelX, kAccelY, kAccelZ};
  how.separator = ',';
  const std::string good = ",0,0,0,0,0,-9.8\n";
  // The clock, a rate or an acceleration of the second line has been damaged on the way.
  const std::string bad =
      GENERATE(",0,?,0,0,0,-9.8\n", ",0,9000,0,0,0,-9.8\n", ",0,0,0,0,0,-9800\n");
  ImuLineCounters counters;
  const auto lines =
      decode(how, "4294937296" + good + "17" + bad + "4294957296" + good, &counters).lines;
  CHECK(counters.bad_values == 1);
  REQUIRE(lines.size() == 2);
  CHECK(*lines[1].clock_ns == 4'294'957'296'000);
  // Nor does it hide an end that comes then.
  const auto over = decode(how, "4294957296" + good + "99999999999999" + bad + "4704" + good).lines;
  REQUIRE(over.size() == 2);
  CHECK(*over[1].clock_ns == 1000 * ((std::int64_t{1} << 32) + 4704));
}

TEST_CASE("Prefix, blanks and checksum", "[imu_line]") {
  using enum LineColumn;
  LineLayout how;
  how.columns = {kGpsWeek, kGpsTowS, kGyroX, kGyroY, kGyroZ, kAccelX, kAccelY, kAccelZ};
  how.separator = ' ';
  how.prefix = "$IMU";
  how.has_checksum = true;
  const std::string body = "IMU 2136  345600.005 0 0 0.1 0 0 -9.8";
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  const char* digits = "0123456789ABCDEF";
  const std::string sentence = "$" + body + "*" + digits[sum / 16] + digits[sum % 16] + "\r\n";
  ImuLineCounters counters;
  std::string broken = sentence;
  broken[20] ^= 1;
  const auto lines = decode(how, sentence + broken + "$OTHER 1\n" + sentence, &counters).lines;
  REQUIRE(lines.size() == 2);
  CHECK(lines[1].gps_time->week() == 2136);
  CHECK(lines[1].gps_time->tow_s() == 345600.005);
  CHECK(counters.bad_checksums == 1);
  CHECK(counters.other_lines == 1);
}

TEST_CASE("A prefix is a whole word, or ends with a sign", "[imu_line]") {
  using enum LineColumn;
  LineLayout how;
  how.columns = {kGyroX, kGyroY, kGyroZ, kAccelX, kAccelY, kAccelZ};
  ImuLineCounters counters;
  const auto count = [&](const std::string& prefix, char separator, const std::string& text) {
    how.prefix = prefix;
    how.separator = separator;
    return decode(how, text, &counters).lines.size();
  };
  // The lines of IMU2 have one column less, so that "2" would be their first.
  CHECK(count("IMU", ',', "IMU,0,0,0,0,0,-9.8\nIMU2,0,0,0,0,-9.8\n") == 1);
  CHECK(counters.other_lines == 1);
  CHECK(count("IMU", ',', "IMUX,0,0,0,0,0,-9.8\nIMU, 0,0,0,0,0,-9.8\nIMU 0,0,0,0,0,-9.8\n") == 2);
  CHECK(count("IMU", ' ', "IMU 0 0 0 0 0 -9.8\nIMU\t0 0 0 0 0 -9.8\nIMU2 0 0 0 0 -9.8\n") == 2);
  CHECK(count("IMU,", ',', "IMU,0,0,0,0,0,-9.8\n") == 1);
  CHECK(count("A:", ',', "A:0,0,0,0,0,-9.8\nB:0,0,0,0,0,-9.8\n") == 1);
  CHECK(count("IMU", ',', "IMU\nIMU,\n") == 0);
  CHECK(counters.bad_columns == 2);
}

TEST_CASE("The end of one connection and the beginning of the next make no line", "[imu_line]") {
  using enum LineColumn;
  LineLayout how;
  how.columns = {kGyroX, kGyroY, kGyroZ, kAccelX, kAccelY, kAccelZ};
  ImuLineDecoder decoder(how);
  LineCollector collector;
  const auto feed = [&](const std::string& text) {
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    decoder.feed(bytes, &collector);
  };
  const std::string line = "0.005,0,0,0,0,-9.8\r\n";
  decoder.begin_connection();
  feed(line + line + "3");
  decoder.begin_connection();
  feed(line + line);
  // A line that began before the connection has lost what came first, here digits of a number.
  decoder.begin_connection();
  feed("05,0,0,0,0,-9.8\r\n" + line);
  // Nor does a line without end, whose connection has gone, cost the next ones.
  feed(std::string(5000, 'a'));
  decoder.begin_connection();
  std::string endless(5000, 'a');
  feed(endless.append("\n").append(line));
  REQUIRE(collector.lines.size() == 4);
  for (const ImuLine& each : collector.lines) CHECK(each.gyro[0] == 0.005);
  CHECK(decoder.counters().first_lines == 4);
  CHECK(decoder.counters().too_long == 1);
  CHECK(decoder.counters().bad_columns == 0);
}

TEST_CASE("A layout that cannot be read is refused with the reason", "[imu_line]") {
  using enum LineColumn;
  CHECK(problem_of(layout()).empty());
  LineLayout how = layout();
  how.axes = {1, 2, -3};
  CHECK_THAT(problem_of(how), Catch::Contains("mirrored"));
  how.axes = {1, 1, 3};
  CHECK_THAT(problem_of(how), Catch::Contains("once each"));
  for (const std::array<int, 3>& good :
       {std::array{1, -2, -3}, std::array{2, 1, -3}, std::array{2, 3, 1}, std::array{-2, 1, 3},
        std::array{-1, -2, 3}}) {
    how.axes = good;
    CHECK(problem_of(how).empty());
  }
  how = layout();
  how.columns[1] = kSkip;
  CHECK_THAT(problem_of(how), Catch::Contains("gyro_x"));
  how = layout();
  how.columns[4] = kGpsWeek;
  CHECK_THAT(problem_of(how), Catch::Contains("together"));
}

}  // namespace leonav
