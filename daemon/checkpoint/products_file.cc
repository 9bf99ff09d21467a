#include "daemon/checkpoint/products_file.h"

#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <utility>

#include "daemon/config/load_config.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_header.h"

namespace leonav {
namespace {

constexpr std::string_view kSumChannel = "CRC32";
constexpr std::size_t kSumBytes = 4;
constexpr std::uintmax_t kMostProductBytes = 1'000'000;

std::uint32_t crc32(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

void append_event(std::string_view channel, ByteSpan data, std::int64_t number, std::string* to) {
  const EventHeaderBytes header =
      encode_event_header({number, 0, static_cast<std::uint32_t>(channel.size()),
                           static_cast<std::uint32_t>(data.size())});
  to->append(reinterpret_cast<const char*>(header.data()), header.size());
  to->append(channel);
  to->append(reinterpret_cast<const char*>(data.data()), data.size());
}

struct EventView {
  EventHeader header;
  std::string_view channel;
  ByteSpan data;
};

// Takes the next event off the text; nullopt: there is none.
std::optional<EventView> take_event(std::string_view* text) {
  EventHeaderBytes bytes;
  if (text->size() < bytes.size()) return std::nullopt;
  std::memcpy(bytes.data(), text->data(), bytes.size());
  const auto header = decode_event_header(bytes);
  if (!header || !header->is_sane() || header->event_bytes() > text->size()) return std::nullopt;
  EventView event;
  event.header = *header;
  event.channel = text->substr(bytes.size(), header->channel_bytes);
  const std::string_view data =
      text->substr(bytes.size() + header->channel_bytes, header->data_bytes);
  event.data = {reinterpret_cast<const std::uint8_t*>(data.data()), data.size()};
  text->remove_prefix(header->event_bytes());
  return event;
}

std::string read_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw ConfigError(path + ": is no ordinary file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kMostProductBytes) throw ConfigError(path + ": is damaged: too long");
  std::ifstream file(path, std::ios::binary);
  std::string text(size, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(size)))
    throw ConfigError(path + ": cannot be read: " + std::strerror(errno));
  return text;
}

// Returns the text before its sum, and the number of events in it by the sum's header. Throws where
// the sum is not that of the text.
std::pair<std::string_view, std::int64_t> without_sum(std::string_view text,
                                                      const std::string& path) {
  const std::size_t sum_bytes = kEventHeaderBytes + kSumChannel.size() + kSumBytes;
  if (text.size() < sum_bytes) throw ConfigError(path + ": is damaged: too short");
  std::string_view end = text.substr(text.size() - sum_bytes);
  text.remove_suffix(sum_bytes);
  const auto sum = take_event(&end);
  std::uint32_t told = 0;
  if (!sum || sum->channel != kSumChannel || sum->data.size() != kSumBytes)
    throw ConfigError(path + ": is damaged: cut short");
  for (const std::uint8_t byte : sum->data) told = told << 8 | byte;
  if (told != crc32(text) || sum->header.timestamp_us != 0)
    throw ConfigError(path + ": is damaged: its sum is wrong");
  return {text, sum->header.number};
}

}  // namespace

std::string products_path(const std::string& checkpoint_path) {
  return checkpoint_path + ".products";
}

std::optional<BroadcastProducts> load_products(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  const std::string text = read_file(path);
  auto [rest, told_events] = without_sum(text, path);
  std::int64_t events = 0;
  BroadcastProducts products;
  Decoder decoder;
  const auto biases = std::make_unique<SignalBiases>();  // too large for a stack
  while (!rest.empty()) {
    const auto event = take_event(&rest);
    if (!event) throw ConfigError(path + ": is damaged: no event log");
    ++events;
    const auto channel = channel_from_name(event->channel);
    Ephemeris ephemeris;
    KlobucharModel ionosphere;
    if (channel == Channel::kEphemeris &&
        decoder.decode(event->data, &ephemeris).fault == InputFault::kNone &&
        products.ephemerides.size() < ProductStore::kMostEphemerides) {
      products.ephemerides.push_back(ephemeris);
    } else if (channel == Channel::kIonosphere &&
               decoder.decode(event->data, &ionosphere).fault == InputFault::kNone) {
      products.ionosphere = ionosphere;
    } else if (channel == Channel::kBiases &&
               decoder.decode(event->data, biases.get()).fault == InputFault::kNone &&
               products.biases.size() + biases->size() <= ProductStore::kMostBiases) {
      products.biases.insert(products.biases.end(), biases->begin(), biases->end());
    } else {
      throw ConfigError(path + ": is of another version of leonav, or damaged");
    }
  }
  if (events != told_events) throw ConfigError(path + ": is damaged: events are missing");
  return products;
}

ProductsText::ProductsText()
    : ephemeris_channel_(channel_name(Channel::kEphemeris)),
      biases_channel_(channel_name(Channel::kBiases)),
      ionosphere_channel_(channel_name(Channel::kIonosphere)) {
  text_.reserve(kUsualBytes);
}

const std::string& ProductsText::of(const BroadcastProducts& products) {
  text_.clear();
  std::int64_t number = 0;
  for (const Ephemeris& ephemeris : products.ephemerides)
    append_event(ephemeris_channel_, encoder_.encode(ephemeris, 0), number++, &text_);
  for (std::span<const SignalBias> rest = products.biases; !rest.empty();) {
    const std::span<const SignalBias> message = first_message_of(rest);
    append_event(biases_channel_, encoder_.encode(message, 0), number++, &text_);
    rest = rest.subspan(message.size());
  }
  if (products.ionosphere) {
    const ByteSpan bytes = encoder_.encode(*products.ionosphere, GpsTime(), 0);
    append_event(ionosphere_channel_, bytes, number++, &text_);
  }
  const std::uint32_t sum = crc32(text_);
  std::array<std::uint8_t, kSumBytes> bytes{};
  for (std::size_t i = 0; i < kSumBytes; ++i)
    bytes[i] = static_cast<std::uint8_t>(sum >> (8 * (kSumBytes - 1 - i)));
  append_event(kSumChannel, bytes, number, &text_);
  return text_;
}

}  // namespace leonav
