// PredictionTest decides whether measurements that contradict the prediction are outliers or show
// that the prediction is wrong.
#pragma once
#include <array>

#include "core/base/gps_time.h"
#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/state/filter_state.h"
#include "core/filter/update/filter_measurement.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

// Clock-removed innovations of every Observable.
using InnovationTables = std::array<ClockRemovedInnovations, kObservables>;
InnovationTables clock_removed_by_observable(const FilterMeasurements& measurements,
                                             const EkfCovariance& covariance);
const ClockRemovedInnovations& table_of(const InnovationTables& tables, Observable observable);

struct PredictionVerdict {
  enum class Action : unsigned char {
    kUse,            // the measurements agree with the prediction, or not with each other either
    kExcludeRanges,  // codes and carriers of this epoch are not used: the next epoch decides
    kExclude,        // this observable is not used: other measurements confirm the prediction
    kInflate,        // the prediction is wrong beyond its covariance by `variance`
  };
  Action action = Action::kUse;
  double variance = 0.0;  // m^2; of Dopplers (m/s)^2
};

// The prediction is suspect where the median standardized innovation of an observable exceeds
// `suspect_ratio`, while the measurements agree with each other (unmodelled_prior_variance() in
// prediction_consistency.h).
class PredictionTest {
 public:
  PredictionTest(const RobustConfig& robust, double suspect_ratio)
      : robust_(robust), suspect_ratio_(suspect_ratio) {}

  // Forgets everything: the filter has started.
  void reset();
  // Forgets when codes last agreed with the prediction: IMU data were missing, or the attitude was
  // set.
  void forget_consistency() { last_consistent_time_ = GpsTime(); }

  // A verdict is derived from this, as it is after the verdicts before have been carried out.
  struct Evidence {
    const FilterMeasurements& measurements;
    const InnovationTables& tables;
    const FilterState& state;
    const EkfCovariance& covariance;
    bool has_attitude = false;
    GpsTime time;
  };
  // Call it once per epoch, before its verdicts.
  void begin_epoch();
  // Returns the verdict on one observable. Call it for Dopplers, then carriers, then codes: where
  // carriers agree on a movement, the codes then agree with it too.
  PredictionVerdict evaluate(Observable observable, const Evidence& evidence,
                             RobustUpdate* robust_update);
  // Records, after the verdicts, whether the codes agreed with the prediction. `suspect` states
  // whether a verdict was not kUse.
  void finish_epoch(const Evidence& evidence, bool suspect);

 private:
  double missing_variance(Observable observable, const Evidence& evidence,
                          RobustUpdate* robust_update) const;
  bool is_confirmed(Observable observable, double error, const Evidence& evidence) const;

  RobustConfig robust_;
  double suspect_ratio_;
  // Observables that agreed with each other against the prediction, in this epoch and the last.
  bool ranges_inconsistent_ = false, doppler_inconsistent_ = false;
  bool ranges_inconsistent_before_ = false, doppler_inconsistent_before_ = false;
  GpsTime last_consistent_time_;  // the last epoch whose codes agreed with the prediction
};

}  // namespace leonav
