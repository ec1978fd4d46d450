#include "core/linear/axial_strains.hpp"

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

void add_matrix(const std::vector<int>& coordinates, const Eigen::MatrixXd& matrix,
                std::vector<Eigen::Triplet<double>>& entries) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    for (std::size_t j = 0; j < coordinates.size(); ++j) {
      entries.emplace_back(coordinates[i], coordinates[j], matrix(i, j));
    }
  }
}

}  // namespace

AxialStrains::AxialStrains(const System& system) {
  for (const auto& term : system.terms()) {
    const auto* source = dynamic_cast<const StrainSource*>(term.get());
    if (source == nullptr) continue;
    const std::vector<QuadraticStrain> found = source->strains();
    strains_.insert(strains_.end(), found.begin(), found.end());
  }
}

Eigen::VectorXd AxialStrains::at(const Eigen::VectorXd& q) const {
  return predicted(q, Eigen::VectorXd::Zero(q.size()));
}

Eigen::VectorXd AxialStrains::predicted(const Eigen::VectorXd& q,
                                        const Eigen::VectorXd& change) const {
  Eigen::VectorXd all(strains_.size());
  for (std::size_t i = 0; i < strains_.size(); ++i) {
    const QuadraticStrain& strain = strains_[i];
    const Eigen::VectorXd local = q(strain.coordinates), step = change(strain.coordinates);
    const Eigen::VectorXd bent = strain.quadratic * local;
    all(i) = strain.linear.dot(local + step) + 0.5 * local.dot(bent) + bent.dot(step);
  }
  return all;
}

void AxialStrains::add_stress_stiffness(const Eigen::VectorXd& c,
                                        std::vector<Eigen::Triplet<double>>& entries) const {
  for (std::size_t i = 0; i < strains_.size(); ++i) {
    const QuadraticStrain& strain = strains_[i];
    add_matrix(strain.coordinates, strain.stiffness * c(i) * strain.quadratic, entries);
  }
}

Eigen::SparseMatrix<double> AxialStrains::coupling(const Eigen::VectorXd& q) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const QuadraticStrain& strain : strains_) {
    const Eigen::VectorXd gradient = strain.linear + strain.quadratic * q(strain.coordinates);
    add_matrix(strain.coordinates,
               strain.stiffness *
                   (gradient * gradient.transpose() - strain.linear * strain.linear.transpose()),
               entries);
  }
  Eigen::SparseMatrix<double> sum(q.size(), q.size());
  sum.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

}  // namespace pleuel
