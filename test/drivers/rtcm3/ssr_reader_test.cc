// SSR messages against pyrtcm: recorded ones, and generated ones for the types that are in none.
#include "drivers/rtcm3/ssr_reader.h"

#include "generated_messages.h"
#include "oracle_programs.h"
#include "rtcm3_streams.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using Words = std::vector<std::string>;

// The recordings give the time of week alone, so any week serves.
const GpsTime kNear = test::day(2023, 8, 17);

struct SsrCollector : test::Rtcm3Collector {
  void on_ssr(const SsrMessage& message) override { corrections.push_back(message); }
  std::vector<SsrMessage> corrections;
};

SsrCollector decode_ssr(const std::vector<std::uint8_t>& bytes) {
  SsrCollector collector;
  Rtcm3Decoder decoder({kNear});
  decoder.feed(bytes, &collector);
  decoder.finish(&collector);
  collector.counters = decoder.counters();
  return collector;
}

// Compares the words of a line, one after the other, with what was decoded.
class LineComparison {
 public:
  LineComparison(const Words& line, std::size_t first) : line_(line), next_(first) {}
  bool has_more() const { return next_ < line_.size(); }
  bool is_key(const std::string& key) {
    if (!has_more() || line_[next_] != key) return false;
    ++next_;
    return true;
  }
  void equal(double value) { different_ += !(std::stod(word()) == value); }
  void equal(const std::string& text) { different_ += word() != text; }
  int different() const { return different_ + static_cast<int>(line_.size() - next_); }

 private:
  std::string word() { return has_more() ? line_[next_++] : "nan"; }
  const Words& line_;
  std::size_t next_;
  int different_ = 0;
};

void compare_biases(const std::vector<SsrBias>& biases, bool is_phase, LineComparison* line) {
  for (const SsrBias& bias : biases) {
    if (!line->is_key(is_phase ? "p" : "b")) line->equal(-1.0);
    line->equal(to_string(bias.code));
    if (is_phase) {
      line->equal(bias.is_integer);
      line->equal(bias.wide_lane);
      line->equal(bias.discontinuities);
    }
    line->equal(bias.bias_m);
  }
}

int differences(const SsrMessage& m, const SsrSatellite& s, const Words& words) {
  const int intervals[] = {1,   2,   5,   10,  15,   30,   60,   120,
                           240, 300, 600, 900, 1800, 3600, 7200, 10800};
  const int different = intervals[std::stoul(words[3])] != static_cast<int>(m.update_interval_s);
  LineComparison rest(words, 4);
  rest.equal(m.more_follow);
  rest.equal(m.issue);
  rest.equal(m.provider);
  rest.equal(m.solution);
  rest.equal(to_string(s.satellite));
  if (s.orbit && rest.is_key("o")) {
    rest.equal(s.orbit->issue);
    rest.equal(s.orbit->beidou_toe ? static_cast<double>(*s.orbit->beidou_toe) : -1.0);
    for (int axis = 0; axis < 3; ++axis) rest.equal(s.orbit->delta_rac_m[axis]);
    for (int axis = 0; axis < 3; ++axis) rest.equal(s.orbit->delta_rate_rac[axis]);
  }
  if (s.clock && rest.is_key("c")) {
    rest.equal(s.clock->c0_m);
    rest.equal(s.clock->c1);
    rest.equal(s.clock->c2);
  }
  if (s.high_rate_clock_m && rest.is_key("h")) rest.equal(*s.high_rate_clock_m);
  if (s.accuracy_index && rest.is_key("a")) rest.equal(*s.accuracy_index);
  if (m.kind == SsrKind::kPhaseBias && rest.is_key("y")) {
    rest.equal(s.yaw_rad);
    rest.equal(s.yaw_rate);
  }
  compare_biases(s.code_biases, false, &rest);
  compare_biases(s.phase_biases, true, &rest);
  return different + rest.different();
}

struct Comparison {
  std::size_t satellites = 0, messages = 0;
  long different = 0;
};

Comparison compare(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  const test::TemporaryFile place("fields.txt", "");
  REQUIRE(test::run(test::oracle_command() + "fields '" + path + "' >'" + place.path() + "'"));
  std::vector<Words> theirs;
  for (Words& line : test::words_of(place.path())) {
    if (line[0] == "S") theirs.push_back(std::move(line));
  }
  const SsrCollector ours = decode_ssr(bytes);
  Comparison result;
  result.messages = ours.corrections.size();
  CHECK(ours.counters.ssr.bad_length + ours.counters.ssr.bad_time == 0);
  for (const SsrMessage& m : ours.corrections) {
    for (const SsrSatellite& s : m.satellites) {
      REQUIRE(result.satellites < theirs.size());
      const Words& words = theirs[result.satellites++];
      const bool is_beidou_time = m.system == System::kBeidou && m.service != SsrService::kIgs;
      const double tow = m.time.plus_seconds(is_beidou_time ? -14.0 : 0.0).tow_s();
      const int d = differences(m, s, words);
      if (std::stod(words[2]) != tow || d > 0) {
        if (result.different++ < 3) FAIL_CHECK(words[1] << " " << words[8] << ": " << d);
      }
    }
  }
  CHECK(result.satellites == theirs.size());
  return result;
}

}  // namespace

TEST_CASE("Recorded corrections agree with pyrtcm to the last bit") {
  if (!test::have_pyrtcm()) return;
  struct Recording {
    const char* name;
    std::size_t messages;
  };
  for (const Recording& r :
       {Recording{test::kSsrHour, 364 + 365 + 365 + 364}, Recording{"wire/rtcm_1240-1264.bin", 12},
        Recording{"wire/rtcm_NTRIP-4076.bin", 7}, Recording{"wire/rtcm_RTCM3.bin", 2}}) {
    if (!test::have_shared_data(r.name)) continue;
    CAPTURE(r.name);
    const std::string path = test::shared_data(r.name);
    const Comparison comparison = compare(path, test::stream_bytes(path));
    CHECK(comparison.messages == r.messages);
    CHECK(comparison.satellites > 50);
    CHECK(comparison.different == 0);
  }
}

TEST_CASE("Generated corrections of every kind agree with pyrtcm to the last bit") {
  if (!test::have_pyrtcm()) return;
  const auto bytes = test::generated_ssr(20);
  const test::TemporaryFile stream("ssr.rtcm3", std::string(bytes.begin(), bytes.end()));
  const Comparison comparison = compare(stream.path(), bytes);
  CHECK(comparison.messages == 20 * 36);
  CHECK(comparison.satellites == 989);
  CHECK(comparison.different == 0);
}

TEST_CASE("Corrections that are cut off, of an impossible time or without a week are counted") {
  const auto bytes = test::generated_ssr(1);
  std::vector<std::uint8_t> stream;
  const auto extents = test::frame_extents(bytes);
  for (const auto& extent : extents) {
    const auto frame = std::span(bytes).subspan(extent.first, extent.size);
    test::append(&stream, test::framed(frame.subspan(3, 9)));  // before the first satellite
    const std::size_t time_at = extent.type == 4076 ? 23 : 12;
    test::append(&stream, test::edited(frame, {{time_at, 20, 604'800}}));
  }
  const SsrCollector decoded = decode_ssr(stream);
  CHECK(decoded.corrections.empty());
  CHECK(decoded.counters.ssr.bad_length == extents.size());
  CHECK(decoded.counters.ssr.bad_time == extents.size());
  SsrCollector collector;
  Rtcm3Decoder decoder;
  decoder.feed(bytes, &collector);
  CHECK(collector.corrections.empty());
  CHECK(decoder.counters().ssr.without_reference == extents.size());
}

}  // namespace leonav
