#include "drivers/sbf/raw_page.h"

#include "drivers/binary/bit_field.h"

namespace leonav {
namespace {

// Copies the bits of a page from the words, whose first one of the page is bit `first`.
CorrectionPage read_page(std::span<const std::uint32_t> words, std::size_t first,
                         PageService service, const SubframeOrigin& origin) {
  constexpr std::size_t kWordBits = 32;
  BitWriter<sizeof(CorrectionPage::bits)> writer;
  for (std::size_t i = first; i < first + CorrectionPage::kBits; ++i) {
    writer.put(words[i / kWordBits] >> (kWordBits - 1 - i % kWordBits), 1);
  }
  return {service, origin.satellite, origin.now, writer.bytes()};
}

}  // namespace

CorrectionPage galileo_page(std::span<const std::uint32_t, kGalileoPageWords> words,
                            const SubframeOrigin& origin) {
  return read_page(words, 0, PageService::kGalileoHas, origin);
}

B2bFrame b2b_frame(std::span<const std::uint32_t, kB2bFrameWords> words,
                   const SubframeOrigin& origin) {
  constexpr std::size_t kNumberBits = 6, kReservedBits = 6;
  return {words[0] >> (32 - kNumberBits),
          read_page(words, kNumberBits + kReservedBits, PageService::kBeidouB2b, origin)};
}

}  // namespace leonav
