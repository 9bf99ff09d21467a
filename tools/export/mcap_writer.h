// The McapWriter writes messages into an MCAP file: chunks with indexes, and a summary.
//
// Format: MCAP specification, version 0 (magic byte '0'), little endian, chunks without
// compression.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/export/output_file.h"

namespace leonav {

// A channel and its schema.
struct McapChannel {
  std::string_view topic, message_encoding;
  std::string_view schema_name, schema_encoding, schema;
};

class McapWriter {
 public:
  // Channels are numbered in their order, from 0. `profile` says what messages mean: "ros2".
  McapWriter(OutputFile* file, std::string_view profile, std::vector<McapChannel> channels);

  // Adds a message; `time_ns` is Unix time.
  void add(std::size_t channel, std::int64_t time_ns, std::string_view data);
  // Writes the last chunk, indexes, statistics and footer. Call it once, last.
  void finish();
  std::uint64_t messages() const { return messages_; }

 private:
  struct IndexEntry {
    std::uint64_t time = 0, offset = 0;  // offset within the chunk
  };
  struct ChunkIndex {
    std::uint64_t first_time = 0, last_time = 0, start = 0, length = 0, index_length = 0, size = 0;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> index_offsets;
  };
  void end_chunk();
  std::string schema_record(std::uint16_t channel) const;
  std::string channel_record(std::uint16_t channel) const;
  void write_summary();
  std::string chunk_index_records() const;
  std::string statistics_record() const;
  // Writes and adds to the checksum of the section.
  void write(std::string_view bytes);
  std::uint32_t take_checksum();

  OutputFile* file_;
  std::vector<McapChannel> channels_;
  std::string chunk_;
  std::uint64_t chunk_first_time_ = 0, chunk_last_time_ = 0;
  std::vector<std::vector<IndexEntry>> chunk_entries_;  // by channel
  std::vector<ChunkIndex> chunks_;
  std::vector<std::uint64_t> counts_;  // by channel
  std::uint64_t messages_ = 0, first_time_ = 0, last_time_ = 0;
  std::uint32_t checksum_ = 0;
};

}  // namespace leonav
