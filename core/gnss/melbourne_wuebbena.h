// The Melbourne-Wuebbena combination: wide-lane carrier minus narrow-lane code, free of geometry
// and ionosphere (W. G. Melbourne 1985; G. Wuebbena 1985). A slip moves it by the difference of the
// two slips, in wide-lane wavelengths; what hides it is the noise of the codes.
#pragma once
#include <boost/container/static_vector.hpp>

namespace leonav {

struct PairValues {
  double first_m = 0.0, second_m = 0.0;            // carriers
  double first_code_m = 0.0, second_code_m = 0.0;  // codes
};

// In metres of wide lane. Frequencies in Hz.
double melbourne_wuebbena_m(const PairValues& values, double first_hz, double second_hz);
double wide_lane_m(double first_hz, double second_hz);
// 1 sigma for codes of `code_sigma_m` each.
double melbourne_wuebbena_sigma_m(double code_sigma_m, double first_hz, double second_hz);

class MelbourneWuebbena {
 public:
  struct Deviation {
    double value_m = 0.0;         // from the last epoch or from the mean, whichever is steadier
    double sigma_m = 0.0;         // of it; 0: nothing to compare with
    double window_m = 0.0;        // mean of the last epochs from the mean before them
    double window_sigma_m = 0.0;  // 0: not enough epochs
  };

  // A new arc begins. `keep_noise`: the variances are the codes' and outlive the ambiguity.
  void clear(bool keep_noise);
  // `model_sigma_m`: what the combination should scatter by.
  Deviation deviation(double value_m, double model_sigma_m) const;
  void update(double value_m, double model_sigma_m);

 private:
  static constexpr std::size_t kWindow = 4;
  using Recent = boost::container::static_vector<double, kWindow>;

  double mean_before() const;
  void learn(double value_m, double model_sigma_m);

  Recent recent_;               // oldest first
  double mean_m_ = 0.0;         // of what left the window
  double epochs_ = 0.0;         // in the mean, bounded
  double variance_ = 0.0;       // from the mean, in units of the model's variance
  double step_variance_ = 0.0;  // of epoch differences, in units of twice the model's variance
  double noise_epochs_ = 0.0;   // that the variances rest on, bounded
};

}  // namespace leonav
