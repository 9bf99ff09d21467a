// The detectors on a synthetic drive at 1 Hz, with and without an inertial prediction.
#include "support/catch.h"
#include "support/slips/slip_scene_1hz.h"

namespace leonav {
namespace {

constexpr double kShare = 0.05;  // of the satellite-epochs slip

void require_good(const test::SlipCounts& found, const test::SlipCounts& none) {
  CHECK(found.injected > 500);
  CHECK(found.detected() >= 0.995);
  CHECK(found.false_rate() <= 0.001);
  CHECK(none.false_rate() <= 0.001);
}

struct Variant {
  const char* name;
  bool CycleSlipConfig::*off;
};
constexpr Variant kVariants[] = {
    {"  without geometry-free", &CycleSlipConfig::use_geometry_free},
    {"  without Melbourne-Wuebbena", &CycleSlipConfig::use_melbourne_wuebbena},
    {"  without Doppler", &CycleSlipConfig::use_doppler},
};

}  // namespace

TEST_CASE("Slips in a moving receiver's carriers are found", "[cycle_slip]") {
  std::cout << "Synthetic drive, 1 Hz, GPS, Galileo and LEO\n";
  test::print_heading();
  for (const double sigma_m : {0.01, -1.0}) {
    test::SlipScene1HzOptions options;
    options.prediction_sigma_m = sigma_m;
    options.duration_s = 600.0;
    test::SlipScene1Hz drive(options);
    const std::string name = sigma_m > 0.0 ? "position change predicted to 1 cm" : "no prediction";
    test::SlipCounts none;
    test::SlipCounts found = test::run_with_slips(drive.scene(), {}, kShare, false, &none);
    test::print_counts(name, found);
    test::print_shares(found);
    require_good(found, none);
    for (const Variant& variant : kVariants) {
      CycleSlipConfig config;
      config.*variant.off = false;
      test::print_counts(variant.name, test::run_with_slips(drive.scene(), config, kShare));
    }
    drive.scene().second_signals = false;
    found = test::run_with_slips(drive.scene(), {}, kShare, false, &none);
    test::print_counts("  single frequency", found);
    test::print_shares(found);
    require_good(found, none);
    drive.scene().second_signals = true;
    if (sigma_m > 0.0) continue;
    drive.scene().use_range_change = false;
    found = test::run_with_slips(drive.scene(), {}, kShare, false, &none);
    test::print_counts("no range change at all", found);
    test::print_shares(found);
    require_good(found, none);
    drive.scene().second_signals = false;
    found = test::run_with_slips(drive.scene(), {}, kShare, false, &none);
    test::print_counts("  single frequency: Doppler alone", found);
    test::print_shares(found);
    CHECK(none.false_rate() <= 0.001);
  }
}

TEST_CASE("Slips are found in a noisy receiver and at other rates", "[cycle_slip]") {
  struct Case {
    const char* name;
    double interval_s, code, carrier, doppler, scintillation;
  };
  test::print_heading();
  for (const Case& c :
       {Case{"5 Hz", 0.2, 1, 1, 1, 1}, Case{"every 5 s", 5.0, 1, 1, 1, 1},
        Case{"noise twice as large", 1.0, 2, 2, 2, 2}, Case{"scintillation 6 mm", 1.0, 1, 1, 1, 3},
        Case{"code noise four times", 1.0, 4, 1, 1, 1}}) {
    test::SlipScene1HzOptions options;
    options.prediction_sigma_m = -1.0;
    options.interval_s = c.interval_s;
    options.duration_s = 300.0 * std::max(1.0, c.interval_s / 2.0);
    options.code_white_m *= c.code;
    options.code_multipath_m *= c.code;
    options.carrier_white_m *= c.carrier;
    options.carrier_multipath_m *= c.carrier;
    options.doppler_white_m_s *= c.doppler;
    options.scintillation_m *= c.scintillation;
    test::SlipScene1Hz drive(options);
    test::SlipCounts none;
    const test::SlipCounts found = test::run_with_slips(drive.scene(), {}, kShare, false, &none);
    test::print_counts(c.name, found);
    CHECK(found.injected > 100);
    CHECK(found.detected() >= 0.995);
    CHECK(found.false_rate() <= 0.001);
    CHECK(none.false_rate() <= 0.001);
  }
}

TEST_CASE("A slip that the receiver reports is found whatever its size", "[cycle_slip]") {
  test::SlipScene1HzOptions options;
  options.duration_s = 120.0;
  test::SlipScene1Hz drive(options);
  drive.scene().second_signals = false;
  drive.scene().use_range_change = false;
  const test::SlipCounts found = test::run_with_slips(drive.scene(), {}, kShare, true);
  test::print_counts("reported by the receiver", found);
  CHECK(found.injected > 100);
  CHECK(found.at_once == found.injected);
}

}  // namespace leonav
