#include "drivers/rtcm3/rtcm3_file_reader.h"

#include <deque>

#include "drivers/text/byte_file.h"

namespace leonav {
namespace {

constexpr const char* kWhat = "RTCM 3 bytes";

}  // namespace

struct Rtcm3FileReader::State : Rtcm3Handler {
  State(const std::string& path, const Rtcm3Options& options)
      : file(path, kWhat), decoder(options) {}

  void on_epoch(const RawEpoch& epoch) override { outputs.emplace_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { outputs.emplace_back(ephemeris); }
  void on_station_position(const StationPosition& position) override {
    outputs.emplace_back(position);
  }
  void on_station_equipment(const StationEquipment& equipment) override {
    outputs.emplace_back(equipment);
  }
  void on_ssr(const SsrMessage& message) override { outputs.emplace_back(message); }

  ByteFile file;
  Rtcm3Decoder decoder;
  std::deque<Rtcm3Output> outputs;  // of the last chunk
  bool at_end = false;
};

Rtcm3FileReader::Rtcm3FileReader(const std::string& path, const Rtcm3Options& options)
    : state_(std::make_unique<State>(path, options)) {}
Rtcm3FileReader::~Rtcm3FileReader() = default;
Rtcm3FileReader::Rtcm3FileReader(Rtcm3FileReader&&) noexcept = default;

bool Rtcm3FileReader::next(Rtcm3Output* output) {
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

Rtcm3Counters Rtcm3FileReader::counters() const { return state_->decoder.counters(); }

std::string first_antenna(const std::string& path) {
  ByteFile file(path, kWhat);
  Rtcm3Framer framer;
  while (true) {
    std::span<const std::uint8_t> bytes = file.next();
    const bool at_end = bytes.empty();
    if (at_end) framer.finish();
    do {
      bytes = bytes.subspan(framer.append(bytes));
      for (Rtcm3Frame frame; framer.next(&frame);) {
        if (!is_station_equipment(frame.type)) continue;
        const auto equipment = read_station_equipment(frame.type, frame.message);
        if (equipment && !equipment->antenna.empty()) return equipment->antenna;
      }
    } while (!bytes.empty());
    if (at_end) return {};
  }
}

}  // namespace leonav
