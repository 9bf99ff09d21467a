#include "drivers/ubx/ubx_file_reader.h"

#include <deque>

#include "drivers/text/byte_file.h"

namespace leonav {

struct UbxFileReader::State : UbxHandler {
  State(const std::string& path, const RxmRawxOptions& options)
      : file(path, "u-blox bytes"), decoder(options) {}

  void on_epoch(const RawEpoch& epoch) override { outputs.emplace_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { outputs.emplace_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { outputs.emplace_back(model); }
  void on_inertial(const EsfReading& reading) override { outputs.emplace_back(reading); }
  void on_page(const CorrectionPage& page) override { outputs.emplace_back(page); }
  void on_biases(const std::vector<SignalBias>& biases) override { outputs.emplace_back(biases); }

  ByteFile file;
  UbxDecoder decoder;
  std::deque<UbxOutput> outputs;  // of the last chunk
  bool at_end = false;
};

UbxFileReader::UbxFileReader(const std::string& path, const RxmRawxOptions& options)
    : state_(std::make_unique<State>(path, options)) {}
UbxFileReader::~UbxFileReader() = default;

bool UbxFileReader::next(UbxOutput* output) {
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

UbxCounters UbxFileReader::counters() const { return state_->decoder.counters(); }

}  // namespace leonav
