#include "drivers/transport/internal/ntrip_reply.h"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <cctype>
#include <limits>
#include <string_view>

#include "drivers/text/parse.h"

namespace leonav {

namespace http = boost::beast::http;

struct NtripReply::Http {
  http::response_parser<http::buffer_body> parser;
};

namespace {

constexpr std::size_t kMaxFirstLine = 512;
// Beast asserts that a first chunk which is the last one has so many bytes ("0" and two ends of
// lines) when it sees it again. Every later chunk follows an end of a line and so has them.
constexpr std::size_t kLeastOfLastChunk = 5;

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

NtripReply::NtripReply() = default;
NtripReply::~NtripReply() = default;

NtripAnswer NtripReply::feed(std::span<const std::uint8_t> bytes,
                             std::vector<std::uint8_t>* stream) {
  if (answer_ != NtripAnswer::kPending && answer_ != NtripAnswer::kStream) return answer_;
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  if (http_ == nullptr && !is_icy_) read_start();
  if (http_ != nullptr) read_http(stream);
  if (is_icy_) read_icy(stream);
  return answer_;
}

// Which kind of answer it is shows in the first line. Only the answers of HTTP are left to the
// parser with their first line.
void NtripReply::read_start() {
  constexpr std::string_view kHttp = "HTTP/";
  constexpr std::uint8_t kTlsAlert = 0x15, kTlsMajor = 0x03;
  if (waiting_.size() >= 2 && waiting_[0] == kTlsAlert && waiting_[1] == kTlsMajor) {
    answer_ = NtripAnswer::kEncrypted;
    return;
  }
  const std::size_t compared = std::min(waiting_.size(), kHttp.size());
  if (std::equal(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(compared),
                 kHttp.begin())) {
    if (compared < kHttp.size()) return;
    http_ = std::make_unique<Http>();
    http_->parser.header_limit(kMaxHeader);
    http_->parser.body_limit(std::numeric_limits<std::uint64_t>::max());
    return;
  }
  const auto end = std::find(waiting_.begin(), waiting_.end(), '\n');
  const auto length = static_cast<std::size_t>(end - waiting_.begin());
  if (length > kMaxFirstLine) {
    answer_ = NtripAnswer::kNotNtrip;
  } else if (end != waiting_.end()) {
    const std::string line(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end + 1);
    read_first_line(line);
  }
}

// Version 1: "ICY 200 OK", "SOURCETABLE 200 OK", "ICY 401 Unauthorized", "ERROR - Bad Password".
void NtripReply::read_first_line(const std::string& line) {
  answer_ = NtripAnswer::kNotNtrip;
  if (line.starts_with("SOURCETABLE")) {
    answer_ = NtripAnswer::kMountpoint;
  } else if (line.starts_with("ERROR")) {
    const std::string lower = lower_case(line);
    if (lower.find("password") != std::string::npos) answer_ = NtripAnswer::kPassword;
    if (lower.find("mount") != std::string::npos) answer_ = NtripAnswer::kMountpoint;
  } else if (line.starts_with("ICY ")) {
    status_ = parse_int(std::string_view(line).substr(4, 3)).value_or(0);
    is_icy_ = status_ == 200;
    decide_status();
  }
}

void NtripReply::decide_status() {
  if (status_ == 200) {
    answer_ = NtripAnswer::kStream;
  } else if (status_ == 401 || status_ == 403) {
    answer_ = NtripAnswer::kPassword;
  } else if (status_ == 404) {
    answer_ = NtripAnswer::kMountpoint;
  } else {
    answer_ = status_ == 0 ? NtripAnswer::kNotNtrip : NtripAnswer::kStatus;
  }
}

// After the status line of version 1 come empty lines, or none, and then the stream.
void NtripReply::read_icy(std::vector<std::uint8_t>* stream) {
  auto begin = waiting_.begin();
  if (!has_begun_) {
    begin = std::find_if(begin, waiting_.end(),
                         [](std::uint8_t byte) { return byte != '\r' && byte != '\n'; });
    has_begun_ = begin != waiting_.end();
  }
  stream->insert(stream->end(), begin, waiting_.end());
  waiting_.clear();
}

void NtripReply::read_http(std::vector<std::uint8_t>* stream) {
  auto& parser = http_->parser;
  std::array<std::uint8_t, 4096> piece;
  std::size_t used = 0;
  while (answer_ == NtripAnswer::kPending || answer_ == NtripAnswer::kStream) {
    if (first_chunk_is_last_ && waiting_.size() - used < kLeastOfLastChunk) break;
    auto& body = parser.get().body();
    body.data = piece.data();
    body.size = piece.size();
    body.more = true;
    const bool is_in_body = parser.is_header_done();
    boost::system::error_code error;
    const std::size_t taken =
        parser.put(boost::asio::buffer(waiting_.data() + used, waiting_.size() - used), error);
    used += taken;
    if (is_in_body && taken > 0) has_chunk_ = true;
    // A first line that is whole and not taken is that of a last chunk, which may have trailers.
    const std::string_view rest(reinterpret_cast<const char*>(waiting_.data()) + used,
                                waiting_.size() - used);
    first_chunk_is_last_ = is_in_body && !has_chunk_ && error == http::error::need_more &&
                           rest.find("\r\n", 1) != std::string_view::npos;
    const bool is_full = error == http::error::need_buffer;
    if (error && !is_full && error != http::error::need_more) {
      answer_ = parser.is_header_done() ? NtripAnswer::kBrokenChunk : NtripAnswer::kNotNtrip;
      break;
    }
    if (answer_ == NtripAnswer::kPending && parser.is_header_done()) decide_header();
    if (answer_ == NtripAnswer::kStream) {
      stream->insert(stream->end(), piece.begin(),
                     piece.end() - static_cast<std::ptrdiff_t>(body.size));
      if (parser.is_done()) answer_ = NtripAnswer::kEnded;
    }
    if (used == waiting_.size() || (taken == 0 && !is_full)) break;
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(used));
  if (waiting_.size() > kMaxHeader) {
    answer_ = parser.is_header_done() ? NtripAnswer::kBrokenChunk : NtripAnswer::kNotNtrip;
  }
}

void NtripReply::decide_header() {
  const auto& header = http_->parser.get();
  status_ = static_cast<int>(header.result_int());
  decide_status();
  if (answer_ != NtripAnswer::kStream) return;
  const auto field = header[http::field::content_type];
  const std::string type = lower_case(std::string(field.data(), field.size()));
  if (type.starts_with("gnss/sourcetable")) {
    answer_ = NtripAnswer::kMountpoint;
  } else if (type.starts_with("text/")) {
    answer_ = NtripAnswer::kNoStream;
  }
}

}  // namespace leonav
