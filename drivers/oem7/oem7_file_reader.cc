#include "drivers/oem7/oem7_file_reader.h"

#include <deque>

#include "drivers/text/byte_file.h"

namespace leonav {

struct Oem7FileReader::State : Oem7Handler {
  State(const std::string& path, const Oem7Options& options)
      : file(path, "NovAtel bytes"), decoder(options) {}

  void on_epoch(const RawEpoch& epoch) override { outputs.emplace_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { outputs.emplace_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { outputs.emplace_back(model); }
  void on_imu(const RawImuIncrements& increments) override { outputs.emplace_back(increments); }

  ByteFile file;
  Oem7Decoder decoder;
  std::deque<Oem7Output> outputs;  // of the last chunk
  bool at_end = false;
};

Oem7FileReader::Oem7FileReader(const std::string& path, const Oem7Options& options)
    : state_(std::make_unique<State>(path, options)) {}
Oem7FileReader::~Oem7FileReader() = default;

bool Oem7FileReader::next(Oem7Output* output) {
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

Oem7Counters Oem7FileReader::counters() const { return state_->decoder.counters(); }

}  // namespace leonav
