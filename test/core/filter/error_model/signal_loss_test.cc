// SignalLoss against series of C/N0.
#include "core/filter/error_model/signal_loss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/filter/error_model/error_class.h"
#include "support/catch.h"

namespace leonav {
namespace {

const SatelliteId kGps7 = {System::kGps, 7}, kLeo7 = {System::kLeo, 7}, kLeo8 = {System::kLeo, 8};

class Series {
 public:
  // Adds an epoch, `passed_s` after the one before, and returns the loss.
  double add(SatelliteId satellite, double cn0_dbhz, double passed_s = 1.0,
             double elevation = 0.5) {
    time_ = time_.plus_seconds(passed_s);
    MeasurementEpoch epoch;
    epoch.time = time_;
    SatelliteInView view;
    view.satellite = satellite;
    view.cn0_dbhz = cn0_dbhz;
    view.elevation = elevation;
    epoch.satellites.push_back(view);
    loss_.add(epoch);
    loss_.add(epoch);  // the assembler may see an epoch several times
    return loss_.loss_db(view);
  }

 private:
  SignalLoss loss_;
  GpsTime time_ = GpsTime::from_week_and_tow(2200, 1000.0);
};

TEST_CASE("a signal loses what it is weaker than it was at most") {
  Series series;
  CHECK(series.add(kGps7, 44.0) == 0.0);
  CHECK(series.add(kGps7, 36.0) == Approx(8.0).margin(0.02));
  CHECK(series.add(kGps7, 47.0) == 0.0);
  CHECK(series.add(kGps7, 41.0) == Approx(6.0).margin(0.02));
}

TEST_CASE("a satellite that sets slowly loses nothing, and the best of long ago is forgotten") {
  Series series;
  double largest = 0.0;
  for (int minute = 0; minute < 60; ++minute)
    largest = std::max(largest, series.add(kGps7, 48.0 - 0.15 * minute, 60.0));
  CHECK(largest < 0.5);
  CHECK(series.add(kGps7, 20.0, 1.0) > 10.0);
  CHECK(series.add(kGps7, 20.0, 7200.0) == 0.0);
}

TEST_CASE("without a C/N0 nothing is lost") {
  Series series;
  series.add(kGps7, 45.0);
  CHECK(series.add(kGps7, 0.0) == 0.0);
  CHECK(series.add(kGps7, std::nan("")) == 0.0);
}

TEST_CASE("a satellite in low orbit loses what it is weaker than others at its elevation") {
  Series series;
  series.add(kLeo7, 50.0);
  CHECK(series.add(kLeo8, 30.0) == Approx(20.0).margin(0.02));
  CHECK(series.add(kLeo7, 44.0, 1.0, 0.9) == 0.0);  // no other has been there
  CHECK(series.add(kLeo8, 44.0, 1.0, 0.5 * std::numbers::pi) == 0.0);
  CHECK(series.add(kLeo7, 50.0, 1.0, 0.0) == 0.0);  // its elevation is not known
  CHECK(series.add(kLeo7, 40.0, 1.0, 0.01) == 0.0);
  CHECK(series.add(kLeo8, 36.0, 1.0, 0.05) == Approx(4.0).margin(0.02));
  CHECK(series.add(kGps7, 20.0) == 0.0);  // a satellite in medium orbit has its own reference
}

TEST_CASE("losses are sorted at 3, 6 and 10 dB") {
  const auto of = [](double loss_db) {
    return error_class(Measurement(), SatelliteInView(), loss_db, false).loss;
  };
  CHECK(of(0.0) == 0);
  CHECK(of(2.9) == 0);
  CHECK(of(3.0) == 1);
  CHECK(of(6.0) == 2);
  CHECK(of(10.0) == 3);
  CHECK(of(40.0) == kLossClasses - 1);
}

}  // namespace
}  // namespace leonav
