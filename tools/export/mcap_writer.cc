#include "tools/export/mcap_writer.h"

#include <algorithm>
#include <boost/crc.hpp>
#include <cstring>

namespace leonav {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::size_t kChunkBytes = 1 << 20;

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

// Record builds the content of one record; lengths and counts stand before what they count.
class Record {
 public:
  template <typename T>
  Record& put(T value) {
    static_assert(std::is_unsigned_v<T>);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      content_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF);
    }
    return *this;
  }
  // Text, an array or a map, with its length in 32 bits.
  Record& sized(std::string_view bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    return raw(bytes);
  }
  Record& raw(std::string_view bytes) {
    content_ += bytes;
    return *this;
  }
  const std::string& content() const { return content_; }
  // Returns the whole record.
  std::string as(Opcode opcode) const {
    Record whole;
    whole.put(static_cast<std::uint8_t>(opcode)).put(static_cast<std::uint64_t>(content_.size()));
    return whole.raw(content_).content();
  }

 private:
  std::string content_;
};

// CRC-32 as in zlib, continued from the value before.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0) {
  using Crc = boost::crc_optimal<32, 0x04C11DB7, 0xFFFFFFFF, 0xFFFFFFFF, true, true>;
  // Boost starts from the value of its register, which is bit-reversed and inverted here.
  std::uint32_t start = ~before, reversed = 0;
  for (int i = 0; i < 32; ++i, start >>= 1) reversed = reversed << 1 | (start & 1);
  Crc crc(reversed);
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace

McapWriter::McapWriter(OutputFile* file, std::string_view profile,
                       std::vector<McapChannel> channels)
    : file_(file),
      channels_(std::move(channels)),
      chunk_entries_(channels_.size()),
      counts_(channels_.size()) {
  write(kMagic);
  write(Record().sized(profile).sized("leonav-export").as(Opcode::kHeader));
  for (std::uint16_t i = 0; i < channels_.size(); ++i) {
    write(schema_record(i));
    write(channel_record(i));
  }
}

// Schema n + 1 belongs to channel n, because 0 is no schema's number.
std::string McapWriter::schema_record(std::uint16_t channel) const {
  const McapChannel& one = channels_[channel];
  return Record()
      .put(static_cast<std::uint16_t>(channel + 1))
      .sized(one.schema_name)
      .sized(one.schema_encoding)
      .sized(one.schema)
      .as(Opcode::kSchema);
}

std::string McapWriter::channel_record(std::uint16_t channel) const {
  const McapChannel& one = channels_[channel];
  return Record()
      .put(channel)
      .put(static_cast<std::uint16_t>(channel + 1))
      .sized(one.topic)
      .sized(one.message_encoding)
      .sized("")  // no metadata
      .as(Opcode::kChannel);
}

void McapWriter::add(std::size_t channel, std::int64_t time_ns, std::string_view data) {
  const auto time = static_cast<std::uint64_t>(time_ns);
  if (chunk_.empty()) chunk_first_time_ = chunk_last_time_ = time;
  chunk_first_time_ = std::min(chunk_first_time_, time);
  chunk_last_time_ = std::max(chunk_last_time_, time);
  chunk_entries_[channel].push_back({time, chunk_.size()});
  chunk_ += Record()
                .put(static_cast<std::uint16_t>(channel))
                .put(static_cast<std::uint32_t>(counts_[channel]))
                .put(time)  // when it was recorded
                .put(time)  // when it was published
                .raw(data)
                .as(Opcode::kMessage);
  first_time_ = messages_ == 0 ? time : std::min(first_time_, time);
  last_time_ = std::max(last_time_, time);
  ++counts_[channel];
  ++messages_;
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  ChunkIndex index;
  index.first_time = chunk_first_time_;
  index.last_time = chunk_last_time_;
  index.start = file_->size();
  index.size = chunk_.size();
  write(Record()
            .put(chunk_first_time_)
            .put(chunk_last_time_)
            .put(static_cast<std::uint64_t>(chunk_.size()))
            .put(crc32(chunk_))
            .sized("")  // no compression
            .put(static_cast<std::uint64_t>(chunk_.size()))
            .raw(chunk_)
            .as(Opcode::kChunk));
  index.length = file_->size() - index.start;
  for (std::uint16_t i = 0; i < channels_.size(); ++i) {
    if (chunk_entries_[i].empty()) continue;
    index.index_offsets.emplace_back(i, file_->size());
    Record entries;
    for (const IndexEntry& one : chunk_entries_[i]) entries.put(one.time).put(one.offset);
    write(Record().put(i).sized(entries.content()).as(Opcode::kMessageIndex));
    chunk_entries_[i].clear();
  }
  index.index_length = file_->size() - index.start - index.length;
  chunks_.push_back(std::move(index));
  chunk_.clear();
}

std::string McapWriter::chunk_index_records() const {
  std::string records;
  for (const ChunkIndex& one : chunks_) {
    Record offsets;
    for (const auto& [channel, offset] : one.index_offsets) offsets.put(channel).put(offset);
    records += Record()
                   .put(one.first_time)
                   .put(one.last_time)
                   .put(one.start)
                   .put(one.length)
                   .sized(offsets.content())
                   .put(one.index_length)
                   .sized("")  // no compression
                   .put(one.size)
                   .put(one.size)
                   .as(Opcode::kChunkIndex);
  }
  return records;
}

std::string McapWriter::statistics_record() const {
  Record counts;
  for (std::uint16_t i = 0; i < channels_.size(); ++i) counts.put(i).put(counts_[i]);
  return Record()
      .put(messages_)
      .put(static_cast<std::uint16_t>(channels_.size()))
      .put(static_cast<std::uint32_t>(channels_.size()))
      .put(std::uint32_t{0})  // attachments
      .put(std::uint32_t{0})  // metadata
      .put(static_cast<std::uint32_t>(chunks_.size()))
      .put(first_time_)
      .put(last_time_)
      .sized(counts.content())
      .as(Opcode::kStatistics);
}

void McapWriter::finish() {
  end_chunk();
  write(Record().put(take_checksum()).as(Opcode::kDataEnd));
  take_checksum();
  write_summary();
}

void McapWriter::write_summary() {
  const std::uint64_t summary = file_->size();
  std::string offsets;
  const auto write_group = [&](Opcode opcode, const std::string& records) {
    const std::uint64_t start = file_->size();
    write(records);
    offsets += Record()
                   .put(static_cast<std::uint8_t>(opcode))
                   .put(start)
                   .put(file_->size() - start)
                   .as(Opcode::kSummaryOffset);
  };
  const auto group_of = [&](bool schemas) {
    std::string records;
    for (std::uint16_t i = 0; i < channels_.size(); ++i) {
      records += schemas ? schema_record(i) : channel_record(i);
    }
    return records;
  };
  write_group(Opcode::kSchema, group_of(true));
  write_group(Opcode::kChannel, group_of(false));
  write_group(Opcode::kStatistics, statistics_record());
  write_group(Opcode::kChunkIndex, chunk_index_records());
  const std::uint64_t summary_offsets = file_->size();
  write(offsets);
  // The checksum covers the footer up to itself; the record's length counts it too.
  Record footer;
  footer.put(summary).put(summary_offsets);
  Record head;
  constexpr std::uint64_t kFooterBytes = 20;
  head.put(static_cast<std::uint8_t>(Opcode::kFooter)).put(kFooterBytes).raw(footer.content());
  write(head.content());
  write(Record().put(take_checksum()).content());
  write(kMagic);
}

void McapWriter::write(std::string_view bytes) {
  checksum_ = crc32(bytes, checksum_);
  file_->write(bytes);
}

std::uint32_t McapWriter::take_checksum() {
  const std::uint32_t checksum = checksum_;
  checksum_ = 0;
  return checksum;
}

}  // namespace leonav
