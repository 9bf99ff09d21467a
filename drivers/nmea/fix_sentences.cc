#include "drivers/nmea/fix_sentences.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "drivers/nmea/fields.h"
#include "drivers/nmea/fix_quality.h"
#include "drivers/nmea/sentence.h"

namespace leonav {
namespace {

constexpr double kKnot_m_s = 1852.0 / 3600.0, kKilometresPerHour = 3.6;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A height with as many of three decimals as fit, so that GGA stays within the 82 of the standard:
// a third decimal of the time takes the place of one.
std::string height_field(double metres, bool is_time_long) {
  const std::size_t most = is_time_long ? 7 : 8;
  int decimals = 3;
  std::string text = number_field(metres, decimals);
  while (text.size() > most && decimals > 0) text = number_field(metres, --decimals);
  return text;
}

double speed_of(const Solution& solution) { return std::hypot(solution.v_n[0], solution.v_n[1]); }

// The course over ground is known where the speed stands out of its error.
double course_of(const Solution& solution) {
  constexpr double kLeastSpeed_m_s = 0.1, kSigmas = 2.0;
  const double sigma_m_s = std::max(solution.sigma_v_n[0], solution.sigma_v_n[1]);
  if (speed_of(solution) < std::max(kLeastSpeed_m_s, kSigmas * sigma_m_s)) return kNone;
  return std::atan2(solution.v_n[1], solution.v_n[0]);
}

void add_place(const Solution& solution, bool has_position, Sentence* sentence) {
  const PlaceFields latitude = latitude_fields(has_position ? solution.latitude : kNone);
  const PlaceFields longitude = longitude_fields(has_position ? solution.longitude : kNone);
  sentence->field(latitude.angle).field(latitude.hemisphere);
  sentence->field(longitude.angle).field(longitude.hemisphere);
}

}  // namespace

std::string gga_sentence(const Solution& solution, const SkyView* sky, const FixOptions& options) {
  const FixQuality quality = quality_of(solution, options.dead_reckoning_limit_m);
  // Dead reckoning has no satellites, whatever the last epoch had.
  const bool has_sky = sky != nullptr && quality.mode == 'A';
  Sentence sentence("GNGGA");
  const std::string time = utc_fields(solution.time).time;
  sentence.field(time);
  add_place(solution, quality.has_position, &sentence);
  sentence.field(std::string(1, quality.gga));
  const int used = has_sky ? std::clamp(sky->used, 0, 99) : 0;
  sentence.field((used < 10 ? "0" : "") + std::to_string(used));
  const double hdop = has_sky && sky->hdop > 0.0 ? std::min(sky->hdop, 99.9) : kNone;
  sentence.field(number_field(hdop, hdop < 9.995 ? 2 : 1));
  const double separation_m = options.geoid_separation_m;
  if (quality.has_position) {
    const bool is_time_long = time.size() > std::string_view("hhmmss.ss").size();
    sentence.field(height_field(solution.height - separation_m, is_time_long)).field("M");
    sentence.field(number_field(separation_m, 1)).field("M");
  } else {
    sentence.field("").field("").field("").field("");
  }
  return sentence.field("").field("").line();  // no differential corrections
}

std::string rmc_sentence(const Solution& solution, const FixOptions& options) {
  const FixQuality quality = quality_of(solution, options.dead_reckoning_limit_m);
  const UtcFields utc = utc_fields(solution.time);
  Sentence sentence("GNRMC");
  sentence.field(utc.time).field(std::string(1, quality.status));
  add_place(solution, quality.has_position, &sentence);
  sentence.field(number_field(quality.has_position ? speed_of(solution) / kKnot_m_s : kNone, 3));
  sentence.field(bearing_field(quality.has_position ? course_of(solution) : kNone));
  sentence.field(utc.date()).field("").field("");  // no magnetic variation
  // V: the program makes no statement whether navigating by it is safe.
  return sentence.field(std::string(1, quality.mode)).field("V").line();
}

std::string vtg_sentence(const Solution& solution, const FixOptions& options) {
  const FixQuality quality = quality_of(solution, options.dead_reckoning_limit_m);
  Sentence sentence("GNVTG");
  const double speed_m_s = quality.has_position ? speed_of(solution) : kNone;
  sentence.field(bearing_field(quality.has_position ? course_of(solution) : kNone)).field("T");
  sentence.field("").field("M");
  sentence.field(number_field(speed_m_s / kKnot_m_s, 3)).field("N");
  sentence.field(number_field(speed_m_s * kKilometresPerHour, 3)).field("K");
  return sentence.field(std::string(1, quality.mode)).line();
}

std::string gst_sentence(const Solution& solution) {
  Sentence sentence("GNGST");
  sentence.field(utc_fields(solution.time).time).field("").field("").field("").field("");
  for (int axis = 0; axis < 3; ++axis) {
    const bool has_position = solution.source != Source::kNone;
    sentence.field(number_field(has_position ? solution.sigma_p_n[axis] : kNone, 3));
  }
  return sentence.line();
}

std::string hdt_sentence(const Solution& solution) {
  const bool has_heading = solution.has_attitude && solution.source != Source::kNone;
  return Sentence("GNHDT")
      .field(bearing_field(has_heading ? solution.yaw : kNone))
      .field("T")
      .line();
}

std::string zda_sentence(const Solution& solution) {
  const UtcFields utc = utc_fields(solution.time);
  Sentence sentence("GNZDA");
  sentence.field(utc.time).field(utc.day).field(utc.month).field(utc.year);
  return sentence.field("00").field("00").line();  // local time is UTC
}

}  // namespace leonav
