#include "core/filter/state/ambiguities.h"

namespace leonav {

int find_ambiguity(const Ambiguities& ambiguities, std::uint32_t arc) {
  for (std::size_t i = 0; i < ambiguities.size(); ++i)
    if (ambiguities[i].arc == arc) return static_cast<int>(i);
  return kNoAmbiguity;
}

void add_ambiguity(const Ambiguity& ambiguity, double sigma_m, Ambiguities* ambiguities,
                   EkfCovariance* covariance) {
  const Eigen::Index n = covariance->rows();
  covariance->conservativeResize(n + 1, n + 1);
  covariance->row(n).setZero();
  covariance->col(n).setZero();
  (*covariance)(n, n) = sigma_m * sigma_m;
  ambiguities->push_back(ambiguity);
}

void remove_ambiguity(int index, Ambiguities* ambiguities, EkfCovariance* covariance) {
  const Eigen::Index last = covariance->rows() - 1;
  const Eigen::Index gone =
      covariance->rows() - static_cast<Eigen::Index>(ambiguities->size()) + index;
  for (Eigen::Index i = gone; i < last; ++i) covariance->col(i) = covariance->col(i + 1);
  for (Eigen::Index i = gone; i < last; ++i) covariance->row(i) = covariance->row(i + 1);
  covariance->conservativeResize(last, last);
  ambiguities->erase(ambiguities->begin() + index);
}

void propagate_ambiguities(const Ambiguities& ambiguities, double dt, EkfCovariance* covariance) {
  const Eigen::Index first = covariance->rows() - static_cast<Eigen::Index>(ambiguities.size());
  for (std::size_t i = 0; i < ambiguities.size(); ++i) {
    const Eigen::Index state = first + static_cast<Eigen::Index>(i);
    (*covariance)(state, state) += ambiguities[i].random_walk * ambiguities[i].random_walk * dt;
  }
}

}  // namespace leonav
