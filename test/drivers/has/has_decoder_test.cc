// Pages to corrections: what is collected, what is refused, when a number names another message.
#include "drivers/has/has_decoder.h"

#include "annex_d.h"
#include "support/catch.h"
#include "support/pages/page_bits.h"

namespace leonav {
namespace {

const GpsTime kTime = GpsTime::from_week_and_tow(2269, 532'800.0);
constexpr SatelliteId kE05{System::kGalileo, 5};

// A page with these fields of its header; `octets` follow.
test::PageBits header(std::uint32_t status, std::uint32_t type, std::uint32_t id,
                      std::uint32_t size, std::uint32_t page) {
  test::PageBits bits;
  bits.add(0, 14).add(status, 2).add(0, 2).add(type, 2).add(id, 5).add(size - 1, 5).add(page, 8);
  return bits;
}

// The only page of a message with an empty mask of the number `mask_id` and clocks of nothing.
CorrectionPage single(std::uint32_t id, std::uint32_t mask_id, double after_s) {
  test::PageBits bits = header(1, 1, id, 1, 1);
  bits.header(0, 32 | 8, mask_id, 0).add(1, 4);
  bits.add(2, 4).flags(40, {7}, 1).flags(16, {0}, 0).add(0, 4).add(0, 6);
  bits.add(5, 4).add(0, 2).signed_number(40, 13);
  return bits.page(PageService::kGalileoHas, kE05, kTime.plus_seconds(after_s));
}

// The pages of an example of the interface document.
std::vector<CorrectionPage> example_pages(int number, std::uint32_t id) {
  std::vector<CorrectionPage> pages;
  const test::AnnexExample example = test::annex_example(number);
  for (const EncodedPage& encoded : example.pages) {
    const auto size = static_cast<std::uint32_t>(example.pages.size());
    test::PageBits bits = header(1, 1, id, size, encoded.id);
    for (const std::uint8_t octet : encoded.octets) bits.add(octet, 8);
    pages.push_back(bits.page(PageService::kGalileoHas, kE05, kTime));
  }
  return pages;
}

}  // namespace

TEST_CASE("A page is read at the places of its fields") {
  const CorrectionPage page =
      header(1, 1, 21, 32, 200).add(0xA5, 8).page(PageService::kGalileoHas, kE05, kTime);
  CHECK(is_intact(page));
  CHECK_FALSE(is_dummy(page));
  const HasPage has = read_has_page(page);
  CHECK(has.status == 1);
  CHECK(has.message_type == 1);
  CHECK(has.message_id == 21);
  CHECK(has.message_size == 32);
  CHECK(has.encoded.id == 200);
  CHECK(has.encoded.octets[0] == 0xA5);
}

TEST_CASE("Pages that carry no part of a message in operation are counted by their reason") {
  HasDecoder decoder;
  const auto add = [&decoder](const test::PageBits& bits, SatelliteId from = kE05,
                              GpsTime received = kTime) {
    CHECK(decoder.add(bits.page(PageService::kGalileoHas, from, received)).empty());
  };
  add(test::PageBits().add(0, 14).add(0xAF3BC3, 24));
  add(header(0, 1, 1, 1, 1));
  add(header(2, 1, 1, 1, 1));
  add(header(3, 1, 1, 1, 1));
  add(header(1, 2, 1, 1, 1));
  add(header(1, 1, 1, 3, 0));
  add(header(1, 1, 1, 3, 4));
  add(header(1, 1, 1, 3, 1), {System::kGps, 5});
  add(header(1, 1, 1, 3, 1), {System::kGalileo, 51});
  add(header(1, 1, 1, 3, 1), kE05, GpsTime());
  CorrectionPage damaged = single(1, 7, 0.0);
  damaged.bits[20] ^= 1;
  CHECK(decoder.add(damaged).empty());
  const HasCounters c = decoder.counters();
  CHECK(c.dummies == 1);
  CHECK(c.not_operational == 2);
  CHECK(c.do_not_use == 1);
  CHECK(c.other_types == 1);
  CHECK(c.bad_ids == 2);
  CHECK(c.bad_satellites == 2);
  CHECK(c.without_time == 1);
  CHECK(c.bad_checksums == 1);
  CHECK(c.pages == 0);
}

TEST_CASE("Pages of two messages may come mixed and twice") {
  if (!test::have_shared_data(test::kAnnexD)) return;
  std::vector<CorrectionPage> first = example_pages(1, 3), second = example_pages(2, 4);
  HasDecoder decoder;
  std::size_t messages = 0;
  // The clocks' message needs the mask of the first one.
  CHECK(decoder.add(second[0]).empty());
  for (const CorrectionPage& page : first) {
    messages += decoder.add(page).size();
    CHECK(decoder.add(page).empty());
  }
  CHECK(messages == 6);
  messages = decoder.add(second[1]).size();
  CHECK(messages == 2);
  const HasCounters c = decoder.counters();
  CHECK(c.messages == 2);
  CHECK(c.repeated == first.size());
  CHECK(c.pages == first.size() + second.size());
}

TEST_CASE("A number names another message later, or at once with another size") {
  HasDecoder decoder;
  REQUIRE(decoder.add(single(9, 1, 0.0)).size() == 1);
  CHECK(decoder.add(single(9, 2, 149.0)).empty());
  CHECK(decoder.add(single(9, 2, 151.0)).size() == 1);
  CHECK(decoder.counters().repeated == 1);
  // Of a message of three pages only two come; then the number is used again.
  const auto part = [](std::uint32_t page, double after_s) {
    return header(1, 1, 10, 3, page)
        .page(PageService::kGalileoHas, kE05, kTime.plus_seconds(after_s));
  };
  CHECK(decoder.add(part(1, 0.0)).empty());
  CHECK(decoder.add(part(2, 1.0)).empty());
  CHECK(decoder.add(single(10, 3, 2.0)).size() == 1);
  CHECK(decoder.counters().incomplete == 1);
  CHECK(decoder.add(part(1, 3.0)).empty());
  CHECK(decoder.add(part(2, 4.0)).empty());
  CHECK(decoder.add(part(3, 160.0)).empty());
  CHECK(decoder.counters().incomplete == 2);
}

TEST_CASE("A message that is no message is counted, and the next one is read") {
  HasDecoder decoder;
  test::PageBits bits = header(1, 1, 5, 1, 1);
  bits.header(3700, 32, 0, 0);
  CHECK(decoder.add(bits.page(PageService::kGalileoHas, kE05, kTime)).empty());
  test::PageBits orphan = header(1, 1, 6, 1, 1);
  orphan.header(0, 8, 30, 0);
  CHECK(decoder.add(orphan.page(PageService::kGalileoHas, kE05, kTime)).empty());
  CHECK(decoder.counters().bad_messages == 1);
  CHECK(decoder.counters().without_mask == 1);
  const std::vector<SsrMessage> messages = decoder.add(single(7, 1, 0.0));
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].service == SsrService::kGalileoHas);
  CHECK(messages[0].at_antenna == true);
  CHECK(messages[0].satellites[0].clock->c0_m == Approx(0.1));
}

}  // namespace leonav
