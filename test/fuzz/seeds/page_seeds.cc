#include "support/pages/page_bits.h"
#include "test/fuzz/seeds/seed_writer.h"

namespace leonav::test {
namespace {

const GpsTime kReceived = GpsTime::from_week_and_tow(2200, 345'600.0);

std::string line_of(const CorrectionPage& page, double after_s) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string text = std::to_string(kReceived.week()) + " " +
                     std::to_string(kReceived.tow_s() + after_s) + " " +
                     std::to_string(page.satellite.number) + " 24 61 ";
  for (const std::uint8_t octet : page.bits) {
    text += kDigits[octet >> 4];
    text += kDigits[octet & 15];
  }
  return text + "\n";
}

// The only page of a message of HAS; the mask of the number 3 is G01 to G03 and E01, E02.
PageBits has_message(std::uint32_t id, std::uint32_t blocks) {
  PageBits bits;
  bits.add(0, 14).add(1, 2).add(0, 2).add(1, 2).add(id, 5).add(0, 5).add(1, 8);
  return bits.header(0, blocks, 3, 1);
}

PageBits mask(std::uint32_t id, std::uint32_t more) {
  PageBits bits = has_message(id, 32 | more);
  bits.add(2, 4);
  bits.add(0, 4).flags(40, {1, 2, 3}, 1).flags(16, {0, 8}, 0).add(0, 1).add(0, 3);
  bits.add(2, 4).flags(40, {1, 2}, 1).flags(16, {1, 4}, 0).add(0, 1).add(0, 3);
  return bits.add(0, 6);
}

std::string has_lines() {
  const SatelliteId from{System::kGalileo, 5};
  std::string text;
  double after_s = 0.0;
  const auto add = [&](const PageBits& bits) {
    text += line_of(bits.page(PageService::kGalileoHas, from, kReceived), after_s += 1.0);
  };
  PageBits clocks = mask(1, 8);
  clocks.add(5, 4).add(0, 2).add(0, 2);
  for (int k = 0; k < 5; ++k) clocks.signed_number(40 * k - 80, 13);
  add(clocks);
  PageBits orbits = has_message(2, 16);
  orbits.add(5, 4);
  for (int k = 0; k < 5; ++k) {
    orbits.add(0, k < 3 ? 8 : 10).signed_number(10 * k, 13).signed_number(-5, 12);
    orbits.signed_number(7, 12);
  }
  add(orbits);
  PageBits biases = has_message(3, 2);
  biases.add(5, 4);
  for (int k = 0; k < 10; ++k) biases.signed_number(20 * k - 100, 11);
  add(biases);
  PageBits again = has_message(4, 8);
  again.add(5, 4).add(0, 2).add(0, 2);
  for (int k = 0; k < 5; ++k) again.signed_number(40 * k - 80, 13);
  add(again);
  return text;
}

PageBits b2b_head(std::uint32_t type, std::uint32_t tod_s) {
  PageBits bits;
  return bits.add(type, 6).add(tod_s, 17).add(0, 4).add(1, 2);
}

std::string b2b_lines() {
  const SatelliteId from{System::kBeidou, 60};
  std::string text;
  double after_s = 0.0;
  const auto add = [&](const PageBits& bits) {
    text += line_of(bits.page(PageService::kBeidouB2b, from, kReceived), after_s += 1.0);
  };
  add(b2b_head(1, 0).add(5, 4).flags(174, {19, 64, 65, 105}, 1));
  PageBits orbits = b2b_head(2, 0);
  for (const std::uint32_t slot : {64U, 65U, 105U}) {
    orbits.add(slot, 9).add(0, 10).add(1, 3);
    orbits.signed_number(-10, 15).signed_number(20, 13).signed_number(-30, 13).add(0b010011, 6);
  }
  add(orbits);
  PageBits clocks = b2b_head(4, 6);
  clocks.add(5, 4).add(0, 5);
  for (int k = 0; k < 4; ++k) clocks.add(1, 3).signed_number(100 * k - 200, 15);
  add(clocks);
  PageBits biases = b2b_head(3, 6);
  biases.add(2, 5).add(64, 9).add(2, 4).add(0, 4).signed_number(50, 12).add(4, 4);
  biases.signed_number(-50, 12).add(105, 9).add(1, 4).add(1, 4).signed_number(9, 12);
  add(biases);
  return text;
}

}  // namespace

void write_page_seeds(SeedWriter* writer) {
  writer->write("has_pages", "message", Seed().byte(0).byte(0).text("# HAS\n" + has_lines()));
  writer->write("b2b_pages", "message", Seed().byte(0).byte(7).text(b2b_lines()));
}

}  // namespace leonav::test
