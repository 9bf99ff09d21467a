#include "drivers/ubx/ubx_file_reader.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>

#include "drivers/text/parse.h"

namespace leonav {

struct UbxFileReader::State : UbxHandler {
  State(const std::string& file_path, const RxmRawxOptions& options)
      : path(file_path), decoder(options) {}

  void on_epoch(const RawEpoch& epoch) override { outputs.emplace_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { outputs.emplace_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { outputs.emplace_back(model); }
  void on_inertial(const EsfReading& reading) override { outputs.emplace_back(reading); }
  void on_page(const CorrectionPage& page) override { outputs.emplace_back(page); }
  void on_biases(const std::vector<SignalBias>& biases) override { outputs.emplace_back(biases); }

  std::string path;
  std::ifstream file;
  UbxDecoder decoder;
  std::deque<UbxOutput> outputs;  // of the last chunk
  bool at_end = false;
};

UbxFileReader::UbxFileReader(const std::string& path, const RxmRawxOptions& options)
    : state_(std::make_unique<State>(path, options)) {
  if (std::filesystem::is_directory(path)) {
    throw FileError(path, 0, "is a directory; name a file of u-blox bytes");
  }
  errno = 0;
  state_->file.open(path, std::ios::binary);
  if (!state_->file) {
    throw FileError(path, 0,
                    std::string("cannot be opened (") + std::strerror(errno) +
                        "); check the path and the permissions");
  }
}

UbxFileReader::~UbxFileReader() = default;

bool UbxFileReader::next(UbxOutput* output) {
  State& s = *state_;
  while (s.outputs.empty() && !s.at_end) {
    std::array<char, 4096> chunk;
    s.file.read(chunk.data(), chunk.size());
    const auto count = static_cast<std::size_t>(s.file.gcount());
    if (s.file.bad()) throw FileError(s.path, 0, "cannot be read to its end; check the disk");
    s.decoder.feed({reinterpret_cast<const std::uint8_t*>(chunk.data()), count}, &s);
    if (!s.file) {
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
