#include "drivers/sbf/sbf_file_reader.h"

#include <deque>

#include "drivers/text/byte_file.h"

namespace leonav {

struct SbfFileReader::State : SbfHandler {
  explicit State(const std::string& path) : file(path, "SBF blocks") {}

  void on_epoch(const RawEpoch& epoch) override { outputs.emplace_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { outputs.emplace_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { outputs.emplace_back(model); }
  void on_biases(const std::vector<SignalBias>& biases) override { outputs.emplace_back(biases); }
  void on_page(const CorrectionPage& page) override { outputs.emplace_back(page); }
  void on_imu(const ExtSensorRates& rates) override { outputs.emplace_back(rates); }

  ByteFile file;
  SbfDecoder decoder;
  std::deque<SbfOutput> outputs;  // of the last chunk
  bool at_end = false;
};

SbfFileReader::SbfFileReader(const std::string& path) : state_(std::make_unique<State>(path)) {}
SbfFileReader::~SbfFileReader() = default;

bool SbfFileReader::next(SbfOutput* output) {
  State& s = *state_;
  while (s.outputs.empty() && !s.at_end) {
    const std::span<const std::uint8_t> bytes = s.file.next();
    s.decoder.feed(bytes, &s);
    if (bytes.empty()) {
      s.at_end = true;
      s.decoder.finish(&s);
    }
  }
  if (s.outputs.empty()) return false;
  *output = std::move(s.outputs.front());
  s.outputs.pop_front();
  return true;
}

SbfCounters SbfFileReader::counters() const { return state_->decoder.counters(); }

}  // namespace leonav
