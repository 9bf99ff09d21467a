// What is asked of an NTRIP caster, and what is made of its answer: whole, byte by byte, damaged.
#include <random>
#include <string>
#include <vector>

#include "drivers/transport/internal/ntrip_endpoint.h"
#include "drivers/transport/internal/ntrip_reply.h"
#include "drivers/transport/internal/ntrip_request.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Result {
  NtripAnswer answer;
  int status;
  std::string stream;
};

// Feeds `text` in pieces of `piece` bytes.
Result feed(const std::string& text, std::size_t piece) {
  NtripReply reply;
  Bytes stream;
  for (std::size_t i = 0; i < text.size(); i += piece) {
    const std::string part = text.substr(i, piece);
    reply.feed({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()}, &stream);
  }
  return {reply.answer(), reply.status(), {stream.begin(), stream.end()}};
}

const std::string kOk = "HTTP/1.1 200 OK\r\nNtrip-Version: Ntrip/2.0\r\n";
const std::string kType = "Content-Type: gnss/data\r\n";
const std::string kChunked = kOk + kType + "Transfer-Encoding: chunked\r\n\r\n";

}  // namespace

TEST_CASE("Base64 is that of RFC 4648", "[ntrip]") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xFF\xFE\xFD") == "//79");
  CHECK(base64("Aladdin:open sesame") == "QWxhZGRpbjpvcGVuIHNlc2FtZQ==");
}

TEST_CASE("A request has what its version wants, and only then a user", "[ntrip]") {
  NtripOptions options;
  options.host = "caster";
  options.mountpoint = "BASE";
  CHECK(ntrip_request(options, NtripVersion::k1, std::nullopt, "$GPGGA") ==
        "GET /BASE HTTP/1.0\r\nUser-Agent: NTRIP leonav\r\nAccept: */*\r\nConnection: close\r\n"
        "\r\n");
  CHECK(ntrip_request(options, NtripVersion::k2, Credentials{"u", "p"}, "$GPGGA") ==
        "GET /BASE HTTP/1.1\r\nHost: caster:2101\r\nNtrip-Version: Ntrip/2.0\r\n"
        "User-Agent: NTRIP leonav\r\nAccept: */*\r\nConnection: close\r\nNtrip-GGA: $GPGGA\r\n"
        "Authorization: Basic dTpw\r\n\r\n");
  options.host = "::1";
  CHECK_THAT(ntrip_request(options, NtripVersion::k2, std::nullopt, ""),
             Catch::Contains("Host: [::1]:2101\r\n"));
}

TEST_CASE("Answers are understood, in whatever pieces they come", "[ntrip]") {
  struct Case {
    std::string text;
    NtripAnswer answer;
    std::string stream;
  };
  const std::vector<Case> cases = {
      {"ICY 200 OK\r\n\r\n\xD3one", NtripAnswer::kStream, "\xD3one"},
      {"ICY 200 OK\r\n\xD3\r\none", NtripAnswer::kStream, "\xD3\r\none"},
      {"ICY 200 OK\r\n\r\n", NtripAnswer::kStream, ""},
      {"ICY 401 Unauthorized\r\n", NtripAnswer::kPassword, ""},
      {"ERROR - Bad Password\r\n", NtripAnswer::kPassword, ""},
      {"ERROR - Mount Point Taken or Invalid\r\n", NtripAnswer::kMountpoint, ""},
      {"SOURCETABLE 200 OK\r\nServer: a\r\n\r\nSTR;B", NtripAnswer::kMountpoint, ""},
      {kChunked + "3\r\none\r\n4;a=b\r\ntwo!\r\n", NtripAnswer::kStream, "onetwo!"},
      {kChunked + "3\r\none\r\n0\r\n\r\n", NtripAnswer::kEnded, "one"},
      {kChunked + "0\r\n\r\n", NtripAnswer::kEnded, ""},
      {kChunked + "00\r\n\r\n", NtripAnswer::kEnded, ""},
      {kChunked + "1\r\nx", NtripAnswer::kStream, "x"},
      {kChunked + "1\r\nxd\r\n\r", NtripAnswer::kBrokenChunk, "x"},
      {kChunked + "5\n\r\n", NtripAnswer::kBrokenChunk, ""},
      {kChunked + "1\r\nx\r\n\r\n", NtripAnswer::kBrokenChunk, "x"},
      {kChunked + "1\r\nx\r\n2\r\nyz", NtripAnswer::kStream, "xyz"},
      {kChunked + "3\r\noneXX\r\n", NtripAnswer::kBrokenChunk, "one"},
      {kChunked + "zz\r\n", NtripAnswer::kBrokenChunk, ""},
      {kOk + kType + "\r\nall to the end", NtripAnswer::kStream, "all to the end"},
      {"HTTP/1.0 200 OK\r\n\r\nno type", NtripAnswer::kStream, "no type"},
      {kOk + kType + "Content-Length: 3\r\n\r\nonetwo", NtripAnswer::kEnded, "one"},
      {kOk + "Content-Type: gnss/sourcetable\r\n\r\nSTR;A", NtripAnswer::kMountpoint, ""},
      {kOk + "Content-Type: Text/HTML\r\n\r\n<html>", NtripAnswer::kNoStream, ""},
      {"HTTP/1.1 401 Unauthorized\r\n\r\n", NtripAnswer::kPassword, ""},
      {"HTTP/1.1 403 Forbidden\r\n\r\n", NtripAnswer::kPassword, ""},
      {"HTTP/1.1 404 Not Found\r\n\r\n", NtripAnswer::kMountpoint, ""},
      {"HTTP/1.1 503 Busy\r\n\r\n", NtripAnswer::kStatus, ""},
      {"HTTP/1.1 302 Found\r\nLocation: b\r\n\r\n", NtripAnswer::kStatus, ""},
      {"HTTP/banana\r\n\r\n", NtripAnswer::kNotNtrip, ""},
      {"SSH-2.0-OpenSSH\r\n", NtripAnswer::kNotNtrip, ""},
      {std::string("\x15\x03\x03\x00\x02\x02\x32", 7), NtripAnswer::kEncrypted, ""},
      {"HTTP/1.1 200 OK\r\nServ", NtripAnswer::kPending, ""},
      {"", NtripAnswer::kPending, ""}};
  for (const Case& one : cases) {
    for (const std::size_t piece : {1, 2, 3, 7, 1000}) {
      CAPTURE(one.text, piece);
      const Result result = feed(one.text, piece);
      CHECK(result.answer == one.answer);
      CHECK(result.stream == one.stream);
    }
  }
}

TEST_CASE("A long stream in chunks of every size comes whole", "[ntrip]") {
  std::mt19937 dice(1);
  std::string text = kChunked, expected;
  for (int i = 0; i < 200; ++i) {
    std::string chunk(1 + dice() % 9000, '\0');
    for (char& c : chunk) c = static_cast<char>(dice());
    std::array<char, 16> length;
    std::snprintf(length.data(), length.size(), "%zX\r\n", chunk.size());
    text += length.data() + chunk + "\r\n";
    expected += chunk;
  }
  for (const std::size_t piece : {97, 4096, 65536}) {
    const Result result = feed(text, piece);
    CHECK(result.answer == NtripAnswer::kStream);
    CHECK(result.stream == expected);
  }
}

TEST_CASE("A header without end is refused at its bound", "[ntrip]") {
  const std::string junk(100'000, 'x');
  CHECK(feed(junk, 100).answer == NtripAnswer::kNotNtrip);
  CHECK(feed("HTTP/1.1 200 OK\r\n" + junk, 100).answer == NtripAnswer::kNotNtrip);
  std::string fields = "HTTP/1.1 200 OK\r\n";
  for (int i = 0; i < 5000; ++i) fields += "X-Field: value\r\n";
  CHECK(feed(fields, 100).answer == NtripAnswer::kNotNtrip);
  CHECK(feed(kChunked + "1" + junk, 100).answer == NtripAnswer::kBrokenChunk);
  CHECK(feed(kChunked + "1;" + junk, 100).answer == NtripAnswer::kBrokenChunk);
}

TEST_CASE("Answers that are cut off or damaged anywhere bring no more than came", "[ntrip]") {
  const std::vector<std::string> answers = {"ICY 200 OK\r\n\r\n\xD3stream",
                                            kChunked + "3\r\none\r\n4\r\ntwo!\r\n0\r\n\r\n",
                                            kOk + "Content-Type: gnss/sourcetable\r\n\r\nSTR;A",
                                            kOk + kType + "Content-Length: 3\r\n\r\nonetwo"};
  std::mt19937 dice(2);
  for (const std::string& whole : answers) {
    for (std::size_t length = 0; length <= whole.size(); ++length) {
      const std::string cut = whole.substr(0, length);
      CHECK(feed(whole, 1000).stream.starts_with(feed(cut, 1000).stream));
    }
    for (int i = 0; i < 3000; ++i) {
      std::string damaged = whole;
      for (std::uint32_t k = 0; k <= dice() % 3; ++k) {
        damaged[dice() % damaged.size()] = static_cast<char>(dice());
      }
      CHECK(feed(damaged, 1 + dice() % 40).stream.size() <= damaged.size());
    }
  }
}

TEST_CASE("Version 1 is tried where nothing, or nothing understood, was answered", "[ntrip]") {
  const auto may_be = [](const std::string& text) {
    NtripReply reply;
    Bytes stream;
    reply.feed({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, &stream);
    return may_be_version_1(reply);
  };
  CHECK(may_be(""));
  CHECK(may_be("HTTP/1.1 400 Bad Request\r\n\r\n"));
  CHECK(may_be("HTTP/1.0 505 HTTP Version Not Supported\r\n\r\n"));
  CHECK(may_be("what?\r\n"));
  CHECK_FALSE(may_be("HTTP/1.1 401 Unauthorized\r\n\r\n"));
  CHECK_FALSE(may_be("HTTP/1.1 404 Not Found\r\n\r\n"));
  CHECK_FALSE(may_be("HTTP/1.1 503 Busy\r\n\r\n"));
  CHECK_FALSE(may_be("ICY 200 OK\r\n\r\n"));
}

}  // namespace leonav
