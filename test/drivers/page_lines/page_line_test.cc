// Lines of pages: the form of recorded ones, and every way a line can be wrong.
#include "drivers/page_lines/page_line.h"

#include <string>

#include "drivers/page_lines/page_file_reader.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

const std::string kHex = "0123456789abcdefABCDEF" + std::string(100, '0');  // 61 octets

std::string line(const std::string& head, const std::string& hex = kHex) { return head + hex; }

bool is_page(const std::string& text) {
  return page_from_line(text, PageService::kGalileoHas).has_value();
}

}  // namespace

TEST_CASE("A line holds time, satellite and octets of a page") {
  const auto page = page_from_line(line("2269\t532800.5\t  7\t6\t 61\t"), PageService::kGalileoHas);
  REQUIRE(page);
  CHECK(page->satellite == SatelliteId{System::kGalileo, 7});
  CHECK(page->received == GpsTime::from_week_and_tow(2269, 532'800.5));
  CHECK(page->bits[0] == 0x01);
  CHECK(page->bits[7] == 0xEF);
  CHECK(page->bits[10] == 0xEF);
  CHECK(page->bits[11] == 0x00);
}

TEST_CASE("The seconds of PPP-B2b are BeiDou's") {
  const auto page = page_from_line(line("2269 604795 59 6 61 "), PageService::kBeidouB2b);
  REQUIRE(page);
  CHECK(page->satellite == SatelliteId{System::kBeidou, 59});
  CHECK(page->received == GpsTime::from_week_and_tow(2270, 9.0));
}

TEST_CASE("Any other line is no page") {
  CHECK(is_page(line("2269 0 1 6 61 ")));
  CHECK(is_page(line("2269 0 1 6 62 ", kHex + "ff")));
  CHECK_FALSE(is_page(""));
  CHECK_FALSE(is_page(line("2269 0 1 6 ")));
  CHECK_FALSE(is_page(line("2269 0 1 6 61 ") + " 5"));
  CHECK_FALSE(is_page(line("0 0 1 6 61 ")));
  CHECK_FALSE(is_page(line("10000 0 1 6 61 ")));
  CHECK_FALSE(is_page(line("2269 604800 1 6 61 ")));
  CHECK_FALSE(is_page(line("2269 -1 1 6 61 ")));
  CHECK_FALSE(is_page(line("2269 nan 1 6 61 ")));
  CHECK_FALSE(is_page(line("2269 0 0 6 61 ")));
  CHECK_FALSE(is_page(line("2269 0 64 6 61 ")));
  CHECK_FALSE(is_page(line("2269 0 E01 6 61 ")));
  CHECK_FALSE(is_page(line("2269 0 1 x 61 ")));
  CHECK_FALSE(is_page(line("2269 0 1 6 62 ")));
  CHECK_FALSE(is_page(line("2269 0 1 6 60 ", kHex.substr(2))));
  CHECK(is_page(line("2269 0 1 6 62 ", std::string(128, '0'))));  // as recorded: 16 words
  CHECK_FALSE(is_page(line("2269 0 1 6 61 ", std::string(258, '0'))));
  CHECK_FALSE(is_page(line("2269 0 1 6 129 ", std::string(256, '0'))));
  CHECK_FALSE(is_page(line("2269 0 1 6 61 ", kHex.substr(1))));
  CHECK_FALSE(is_page(line("2269 0 1 6 61 ", "g" + kHex.substr(1))));
  CHECK_FALSE(is_page(line("2269 0 1 6 62 ", kHex + "0g")));
}

TEST_CASE("A file's remarks are left out and its other lines counted") {
  const std::string good = line("2269 100 1 6 61 ") + "\n";
  const test::TemporaryFile file("pages.has", "# remark\n\n" + good + "damaged\n" + good + "7\n");
  PageFileReader reader(file.path(), PageService::kGalileoHas);
  CorrectionPage page;
  CHECK(reader.next(&page));
  CHECK(reader.next(&page));
  CHECK_FALSE(reader.next(&page));
  CHECK(reader.counters().bad_lines == 2);
  CHECK(reader.counters().first_bad_line == 4);
}

}  // namespace leonav
