// The Rtcm3Format publishes the observations, broadcast ephemerides and corrections of an RTCM 3
// stream.
#pragma once
#include <cstdint>
#include <set>

#include "drivers/rtcm3/rtcm3_decoder.h"
#include "tools/connect/formats/outputs/receiver_output.h"
#include "tools/connect/formats/receivers/station_monitor.h"
#include "tools/connect/formats/stream_format.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of the MSM of an
// instant, EPHEMERIS of 1019, 1042, 1045 and 1046, CORRECTED_STATES and BIASES of SSR. Besides,
// ephemerides are repeated. RTCM gives no week: it is that of a day that is told, otherwise that of
// the host's clock at each arrival, which may be wrong by three days.
class Rtcm3Format final : public StreamFormat, private Rtcm3Handler {
 public:
  // `day`: an instant within three days of the stream's beginning; unset: the stream is live.
  // `repeat_s`: as of NavigationRepeater. The epochs' arrivals set `clock`. `is_service`: the
  // stream is a correction service's, and observations in it are those of some station.
  // `corrections`, if given, gets ephemerides and corrections. The pointers must outlive this
  // object.
  Rtcm3Format(GpsTime day, double repeat_s, GpsClock* clock, MessageOutput* output,
              bool is_service = false, CorrectionOutput* corrections = nullptr)
      : is_live_(!day.is_set()),
        is_service_(is_service),
        clock_(clock),
        corrections_(corrections),
        receiver_(repeat_s, clock, output, corrections, ephemeris_remedy),
        decoder_({day}) {}

  void on_open() override { decoder_.allow_other_station(); }
  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::optional<DataTime> data_time() const override;
  std::string detail() const override;
  std::string why_no_frames() const override;
  std::string why_no_messages() const override { return joined({why_none(), host_doubt()}); }
  std::vector<FormatNews> take_news() override;

 private:
  static const char* ephemeris_remedy(System system);
  void on_epoch(const RawEpoch& epoch) override;
  void on_ephemeris(const Ephemeris& ephemeris) override;
  void on_stated_toe(GpsTime time) override;
  void on_station_position(const StationPosition& position) override;
  void on_ssr(const SsrMessage& message) override;
  void tell_time();
  GpsTime time_of_arrival(GpsTime of_message) const;
  // Of a live service without epochs; else unset.
  GpsTime service_time() const;
  std::string why_none() const;
  std::string host_doubt() const;
  std::string week_text() const;
  std::string station_text() const;
  std::string unused_news();

  bool is_live_, is_service_;
  GpsClock* clock_;
  CorrectionOutput* corrections_;
  ReceiverOutput receiver_;
  Rtcm3Decoder decoder_;
  StationMonitor station_;
  std::set<std::uint16_t> told_unused_;  // numbers of messages
  bool others_are_told_ = false;         // that there are more of them
  std::int64_t arrival_ns_ = 0;          // of the bytes at hand
  GpsTime last_epoch_;                   // also of a station; and its arrival
  std::int64_t last_epoch_ns_ = 0;
  GpsTime last_ssr_;                                     // time of the newest correction
  std::uint64_t ssr_messages_ = 0, station_epochs_ = 0;  // published; left out
};

}  // namespace leonav
