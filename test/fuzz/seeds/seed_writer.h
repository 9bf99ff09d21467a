// The seeds of the corpus that leonav's own encoders make.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace leonav::test {

using SeedBytes = std::vector<std::uint8_t>;

// Bytes one after the other.
class Seed {
 public:
  Seed& byte(std::size_t value) {
    bytes_.push_back(static_cast<std::uint8_t>(value & 0xFF));
    return *this;
  }
  Seed& half(std::size_t value) { return byte(value).byte(value >> 8); }
  Seed& add(std::span<const std::uint8_t> more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
    return *this;
  }
  Seed& text(std::string_view more) {
    for (const char letter : more) byte(static_cast<unsigned char>(letter));
    return *this;
  }
  const SeedBytes& bytes() const { return bytes_; }

 private:
  SeedBytes bytes_;
};

// Writes into a folder for each target.
class SeedWriter {
 public:
  explicit SeedWriter(std::filesystem::path corpus) : corpus_(std::move(corpus)) {}

  void write(std::string_view target, std::string_view name, const Seed& seed) {
    const std::filesystem::path folder = corpus_ / target;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(seed.bytes().data()),
               static_cast<std::streamsize>(seed.bytes().size()));
  }

 private:
  std::filesystem::path corpus_;
};

void write_message_seeds(SeedWriter* writer);
void write_log_seeds(SeedWriter* writer);
void write_state_seeds(SeedWriter* writer);  // checkpoint, products
void write_page_seeds(SeedWriter* writer);
void write_script_seeds(SeedWriter* writer);

// Messages of every input channel, with the channel.
struct SeedMessage {
  std::uint8_t channel = 0;
  SeedBytes bytes;
};
std::vector<SeedMessage> seed_messages();

}  // namespace leonav::test
