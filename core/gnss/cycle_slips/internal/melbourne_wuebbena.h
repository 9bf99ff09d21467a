// This unit follows the Melbourne-Wuebbena combination: wide-lane carrier minus narrow-lane code,
// free of geometry and ionosphere (W. G. Melbourne 1985; G. Wuebbena 1985). A slip moves it by the
// difference of the two slips, in wide-lane wavelengths; the noise of the codes limits what it
// shows.
#pragma once
#include <boost/container/static_vector.hpp>

namespace leonav {

// Carriers and codes of a pair of signals, m.
struct PairValues {
  double first_m = 0.0, second_m = 0.0;            // carriers
  double first_code_m = 0.0, second_code_m = 0.0;  // codes
};

// Returns the combination in metres of wide lane. Frequencies are in Hz.
double melbourne_wuebbena_m(const PairValues& values, double first_hz, double second_hz);
// Returns the wide-lane wavelength c / |f1 - f2|, in m.
double wide_lane_m(double first_hz, double second_hz);
// Returns 1 sigma of the combination (m) for codes of `code_sigma_m` each.
double melbourne_wuebbena_sigma_m(double code_sigma_m, double first_hz, double second_hz);

// MelbourneWuebbena keeps the statistics of the combination over one arc.
class MelbourneWuebbena {
 public:
  struct Deviation {
    double value_m = 0.0;         // from the last epoch or from the mean, whichever scatters less
    double sigma_m = 0.0;         // of value_m; 0: nothing to compare with
    double window_m = 0.0;        // mean of the last epochs from the mean before them
    double window_sigma_m = 0.0;  // 0: not enough epochs
  };

  // Begins a new arc. With `keep_noise` the variances are kept: they are the codes' and outlive the
  // ambiguity.
  void clear(bool keep_noise);
  // Compares a value with the arc; `model_sigma_m` is the expected scatter of the combination.
  Deviation deviation(double value_m, double model_sigma_m) const;
  void update(double value_m, double model_sigma_m);

 private:
  static constexpr std::size_t kWindow = 4;
  using Recent = boost::container::static_vector<double, kWindow>;

  double mean_before() const;
  void learn(double value_m, double model_sigma_m);

  Recent recent_;               // oldest first
  double mean_m_ = 0.0;         // mean of the values that left the window
  double epochs_ = 0.0;         // epochs in the mean, bounded
  double variance_ = 0.0;       // from the mean, in units of the model's variance
  double step_variance_ = 0.0;  // of epoch differences, in units of twice the model's variance
  double noise_epochs_ = 0.0;   // epochs on which the variances are based, bounded
};

}  // namespace leonav
