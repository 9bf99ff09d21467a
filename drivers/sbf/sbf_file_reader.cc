#include "drivers/sbf/sbf_file_reader.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>

#include "drivers/text/parse.h"

namespace leonav {

struct SbfFileReader::State : SbfHandler {
  explicit State(const std::string& file_path) : path(file_path) {}

  void on_epoch(const RawEpoch& epoch) override { outputs.emplace_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { outputs.emplace_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { outputs.emplace_back(model); }
  void on_biases(const std::vector<SignalBias>& biases) override { outputs.emplace_back(biases); }
  void on_page(const CorrectionPage& page) override { outputs.emplace_back(page); }
  void on_imu(const ExtSensorRates& rates) override { outputs.emplace_back(rates); }

  std::string path;
  std::ifstream file;
  SbfDecoder decoder;
  std::deque<SbfOutput> outputs;  // of the last chunk
  bool at_end = false;
};

SbfFileReader::SbfFileReader(const std::string& path) : state_(std::make_unique<State>(path)) {
  if (std::filesystem::is_directory(path)) {
    throw FileError(path, 0, "is a directory; name a file of SBF blocks");
  }
  errno = 0;
  state_->file.open(path, std::ios::binary);
  if (!state_->file) {
    throw FileError(path, 0,
                    std::string("cannot be opened (") + std::strerror(errno) +
                        "); check the path and the permissions");
  }
}

SbfFileReader::~SbfFileReader() = default;

bool SbfFileReader::next(SbfOutput* output) {
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

SbfCounters SbfFileReader::counters() const { return state_->decoder.counters(); }

}  // namespace leonav
