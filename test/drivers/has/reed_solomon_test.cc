// The code of HAS messages, by the examples of its interface document.
#include "drivers/has/reed_solomon.h"

#include <algorithm>
#include <random>

#include "annex_d.h"
#include "support/catch.h"

namespace leonav {
namespace {

// The first code word of example 1: the first octets of 15 pages, and of the message.
constexpr std::array<std::uint8_t, 15> kIds = {55,  56,  57,  58,  59,  174, 175, 176,
                                               187, 188, 239, 240, 241, 252, 253};
constexpr std::array<std::uint8_t, 15> kSent = {132, 52, 85,  44,  55,  187, 117, 143,
                                                203, 29, 122, 125, 161, 207, 215};
constexpr std::array<std::uint8_t, 15> kMessage = {0,  255, 71, 67,  79, 240, 64, 221,
                                                   31, 174, 0,  128, 4,  0,   32};

std::vector<EncodedPage> published_word() {
  std::vector<EncodedPage> pages(kIds.size());
  for (std::size_t i = 0; i < pages.size(); ++i) {
    pages[i].id = kIds[i];
    pages[i].octets[0] = kSent[i];
  }
  return pages;
}

}  // namespace

TEST_CASE("The published code word decodes to the published octets, in any order of pages") {
  std::vector<EncodedPage> pages = published_word();
  std::mt19937 random(1);
  for (int i = 0; i < 5; ++i) {
    const auto message = decode_reed_solomon(pages);
    REQUIRE(message);
    REQUIRE(message->size() == kIds.size() * kHasPageOctets);
    for (std::size_t k = 0; k < kMessage.size(); ++k) {
      CHECK((*message)[k * kHasPageOctets] == kMessage[k]);
      CHECK((*message)[k * kHasPageOctets + 1] == 0);
    }
    std::shuffle(pages.begin(), pages.end(), random);
  }
}

TEST_CASE("The first 32 pages are the message itself, and mix with pages of parity") {
  // Of the published word, whose octets beyond 15 are zero, the parity and some of the message.
  std::vector<EncodedPage> pages = published_word();
  for (const std::size_t i : {2U, 7U, 14U}) {
    pages[i] = {};
    pages[i].id = static_cast<std::uint8_t>(i + 1);
    pages[i].octets[0] = kMessage[i];
  }
  const auto message = decode_reed_solomon(pages);
  REQUIRE(message);
  for (std::size_t k = 0; k < kMessage.size(); ++k) {
    CHECK((*message)[k * kHasPageOctets] == kMessage[k]);
  }
}

TEST_CASE("Numbers of pages that no message has are refused") {
  CHECK_FALSE(decode_reed_solomon({}));
  CHECK_FALSE(decode_reed_solomon(std::vector<EncodedPage>(33)));
  std::vector<EncodedPage> pages = published_word();
  pages[3].id = pages[9].id;
  CHECK_FALSE(decode_reed_solomon(pages));
  pages[3].id = 0;
  CHECK_FALSE(decode_reed_solomon(pages));
  pages[3].id = 16;  // beyond the message, and always zero
  CHECK_FALSE(decode_reed_solomon(pages));
}

TEST_CASE("Both examples of the interface document decode to their octets") {
  if (!test::have_shared_data(test::kAnnexD)) return;
  for (const int number : {1, 2}) {
    const test::AnnexExample example = test::annex_example(number);
    REQUIRE(example.pages.size() == (number == 1 ? 15U : 2U));
    const auto message = decode_reed_solomon(example.pages);
    REQUIRE(message);
    CHECK(*message == example.octets);
  }
}

}  // namespace leonav
