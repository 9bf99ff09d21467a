// The NtripReply takes what a caster answers apart: its decision, then the bytes of the stream.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace leonav {

enum class NtripAnswer : std::uint8_t {
  kPending,      // not all of the header has come
  kStream,       // the stream's bytes follow
  kPassword,     // user or password is wrong, or has no right (401, 403)
  kMountpoint,   // there is no such mountpoint (404, or the source table)
  kNoStream,     // a page of text
  kStatus,       // another status of HTTP, status()
  kNotNtrip,     // no answer of HTTP or NTRIP, or a header without end
  kEncrypted,    // the beginning of TLS
  kEnded,        // the caster has ended the stream
  kBrokenChunk,  // the chunks of HTTP do not fit together
};

// Memory is bounded whatever comes: the header by kMaxHeader, the rest by what one feed() brings.
class NtripReply {
 public:
  static constexpr std::size_t kMaxHeader = 8192;

  NtripReply();
  ~NtripReply();

  // Appends the stream's bytes among `bytes` to `stream`. Once the answer is neither kPending nor
  // kStream, everything else is dropped.
  NtripAnswer feed(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>* stream);

  NtripAnswer answer() const { return answer_; }
  // Of HTTP; 0: none has come.
  int status() const { return status_; }

 private:
  struct Http;

  void read_start();
  void read_first_line(const std::string& line);
  void decide_status();
  void read_http(std::vector<std::uint8_t>* stream);
  void decide_header();
  void read_icy(std::vector<std::uint8_t>* stream);

  NtripAnswer answer_ = NtripAnswer::kPending;
  int status_ = 0;
  std::vector<std::uint8_t> waiting_;  // has come, and is not taken apart yet
  std::unique_ptr<Http> http_;         // null: the answer of version 1, or not known yet
  bool is_icy_ = false, has_begun_ = false;
  bool has_chunk_ = false, first_chunk_is_last_ = false;  // of HTTP's chunks
};

}  // namespace leonav
