#include "optimization/design/size_lists.hpp"

#include "core/base/eager_matrices.hpp"

namespace pleuel {

SizeLists::SizeLists(const std::vector<DesignVariable>& variables) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (!variables[i].has_choices()) continue;
    List list{static_cast<Eigen::Index>(i), {}};
    for (const SizeChoice& choice : variables[i].choices) list.values.push_back(choice.value);
    lists_.push_back(std::move(list));
  }
}

double SizeLists::mean_gap(std::size_t k) const {
  const std::vector<double>& values = lists_[k].values;
  if (values.size() < 2) return 0.0;
  return (values.back() - values.front()) / static_cast<double>(values.size() - 1);
}

double SizeLists::combinations() const {
  double product = 1.0;
  for (const List& list : lists_) product *= static_cast<double>(list.values.size());
  return product;
}

std::vector<Sizes> SizeLists::all() const {
  std::vector<Sizes> all;
  Sizes choice(count(), 0);
  for (bool is_new = true; is_new;) {
    all.push_back(choice);
    is_new = false;
    for (std::size_t k = count(); k-- > 0 && !is_new;) {
      is_new = ++choice[k] < sizes(k);
      if (!is_new) choice[k] = 0;
    }
  }
  return all;
}

Eigen::VectorXd SizeLists::design(const Sizes& choice, Eigen::VectorXd x) const {
  for (std::size_t k = 0; k < count(); ++k) x(variable(k)) = value(k, choice[k]);
  return x;
}

Sizes SizeLists::below(const Eigen::VectorXd& x) const {
  Sizes found(count(), 0);
  for (std::size_t k = 0; k < count(); ++k) {
    while (found[k] + 1 < sizes(k) && value(k, found[k] + 1) <= x(variable(k))) ++found[k];
  }
  return found;
}

Sizes SizeLists::nearest(const Eigen::VectorXd& x) const {
  Sizes found = below(x);
  for (std::size_t k = 0; k < count(); ++k) {
    const double at = x(variable(k));
    const bool has_next = found[k] + 1 < sizes(k);
    if (has_next && value(k, found[k] + 1) - at < at - value(k, found[k])) ++found[k];
  }
  return found;
}

std::vector<Sizes> SizeLists::neighbours(const Sizes& from) const {
  std::vector<Sizes> all;
  for (std::size_t k = 0; k < count(); ++k) {
    for (const int step : {-1, 1}) {
      Sizes one = from;
      one[k] += step;
      if (one[k] >= 0 && one[k] < sizes(k)) all.push_back(std::move(one));
    }
  }
  return all;
}

std::vector<Sizes> SizeLists::exchanges(const Sizes& from) const {
  std::vector<Sizes> all;
  for (std::size_t k = 0; k < count(); ++k) {
    for (int size = 0; size < sizes(k); ++size) {
      if (size == from[k]) continue;
      all.push_back(from);
      all.back()[k] = size;
    }
  }
  return all;
}

}  // namespace pleuel
