#include "tools/serve/sentence_feed.h"

#include <algorithm>
#include <cmath>

#include "drivers/nmea/satellite_sentences.h"

namespace leonav {
namespace {

std::string sentences(SentenceKind kind, const Solution& solution, const SkyView* sky,
                      const FixOptions& fix) {
  switch (kind) {
    case SentenceKind::kGga:
      return gga_sentence(solution, sky, fix);
    case SentenceKind::kRmc:
      return rmc_sentence(solution, fix);
    case SentenceKind::kVtg:
      return vtg_sentence(solution, fix);
    case SentenceKind::kGst:
      return gst_sentence(solution);
    case SentenceKind::kGsa:
      return gsa_sentences(solution, sky);
    case SentenceKind::kGsv:
      return gsv_sentences(sky);
    case SentenceKind::kHdt:
      return hdt_sentence(solution);
    case SentenceKind::kZda:
      break;
  }
  return zda_sentence(solution);
}

}  // namespace

std::shared_ptr<const Batch> SentenceFeed::on_solution(std::span<const std::uint8_t> bytes) {
  Solution solution;
  if (decode_output(bytes, &solution) != InputFault::kNone) {
    ++refused_;
    return nullptr;
  }
  ++solutions_;
  last_ = solution;
  return pace_.is_due(solution.time) ? sentences_of(solution) : nullptr;
}

void SentenceFeed::on_epoch(std::span<const std::uint8_t> bytes) {
  if (decode_output(bytes, &epoch_) != InputFault::kNone) {
    ++refused_;
    return;
  }
  SkyView sky;
  sky.time = epoch_.time;
  sky.used = epoch_.satellites_used;
  sky.pdop = epoch_.pdop;
  sky.hdop = epoch_.hdop;
  sky.vdop = epoch_.vdop;
  for (const OutputSatellite& one : epoch_.satellites) {
    sky.satellites.push_back(
        {one.satellite, one.elevation, one.azimuth, one.cn0_dbhz, is_used(one.reason)});
  }
  sky_ = sky;
}

std::shared_ptr<const Batch> SentenceFeed::sentences_of(const Solution& solution) const {
  const bool is_recent =
      sky_ && std::abs(seconds_between(solution.time, sky_->time)) <= kLongestSkyAge_s;
  Batch batch;
  for (const SentenceKind kind : kinds_) {
    batch.text += sentences(kind, solution, is_recent ? &*sky_ : nullptr, fix_);
  }
  batch.sentences = static_cast<int>(std::count(batch.text.begin(), batch.text.end(), '\n'));
  if (batch.sentences == 0) return nullptr;
  return std::make_shared<const Batch>(std::move(batch));
}

}  // namespace leonav
