#include "core/system/projected_term.hpp"

#include <array>

namespace pleuel {

LocalState::LocalState(const CoordinateMap& map)
    : local(map.size(), int_size(map.multipliers)),
      q(map.columns()),
      v(map.columns()),
      a(map.columns()) {}

void LocalState::set(const CoordinateMap& map, const State& state) {
  local.time = state.time;
  map.gather(state.q, q, local.q);
  map.gather(state.v, v, local.v);
  map.gather(state.a, a, local.a);
  for (std::size_t i = 0; i < map.multipliers.size(); ++i) {
    local.lambda(i) = state.lambda(map.multipliers[i]);
  }
}

ProjectedTerm::ProjectedTerm(std::unique_ptr<Term> inner, CoordinateMap map, int coordinates)
    : inner_(std::move(inner)),
      map_(std::move(map)),
      coordinates_(coordinates),
      state_(map_),
      residual_(locals() + multipliers()),
      projected_(map_.columns()),
      tangent_(residual_.size(), residual_.size()),
      half_(residual_.size(), map_.columns()),
      full_(map_.columns(), map_.columns()) {
  inner_->declare_entries(inner_entries_);
}

void ProjectedTerm::declare_entries(EntryList& entries) const {
  for (int row : map_.coordinates) {
    for (int col : map_.coordinates) entries.emplace_back(row, col);
    for (int i = 0; i < multipliers(); ++i) entries.emplace_back(row, row_of_multiplier(i));
  }
  for (int i = 0; i < multipliers(); ++i) {
    for (int col : map_.coordinates) entries.emplace_back(row_of_multiplier(i), col);
  }
}

/// Adds the local residual to the system's.
void ProjectedTerm::scatter(Eigen::VectorXd& residual) {
  projected_.noalias() = map_.rows.transpose() * residual_.head(locals());
  for (int i = 0; i < map_.columns(); ++i) {
    residual(map_.coordinates[i]) += projected_(i);
  }
  for (int i = 0; i < multipliers(); ++i) residual(row_of_multiplier(i)) += residual_(locals() + i);
}

void ProjectedTerm::add_residual(const State& state, ConstraintLevel level,
                                 Eigen::VectorXd& residual) {
  state_.set(map_, state);
  residual_.setZero();
  inner_->add_residual(state_.local, level, residual_);
  scatter(residual);
}

void ProjectedTerm::prepare(std::size_t weights) {
  const std::size_t needed = weights * inner_entries_.size();
  if (values_.size() < needed) values_.resize(needed);
}

/// The dense local tangent of one of the weights.
void ProjectedTerm::set_tangent(std::size_t block) {
  tangent_.setZero();
  const double* value = values_.data() + block * inner_entries_.size();
  for (const auto& [row, col] : inner_entries_) tangent_(row, col) += *value++;
}

void ProjectedTerm::write_projected(double* entries) {
  const int k = map_.columns(), n = locals(), m = multipliers();
  half_.noalias() = tangent_.leftCols(n) * map_.rows;
  full_.noalias() = map_.rows.transpose() * half_.topRows(n);
  for (int row = 0; row < k; ++row) {
    for (int col = 0; col < k; ++col) *entries++ = full_(row, col);
    for (int i = 0; i < m; ++i) *entries++ = map_.rows.col(row).dot(tangent_.col(n + i).head(n));
  }
  for (int i = 0; i < m; ++i) {
    for (int col = 0; col < k; ++col) *entries++ = half_(n + i, col);
  }
}

void ProjectedTerm::linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                              Eigen::VectorXd& residual, const EntryBlocks& entries) {
  prepare(weights.size());
  state_.set(map_, state);
  residual_.setZero();
  inner_->linearize(state_.local, weights, level, residual_,
                    {values_.data(), static_cast<std::ptrdiff_t>(inner_entries_.size())});
  scatter(residual);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    set_tangent(i);
    write_projected(entries.block(i));
  }
}

void ProjectedTerm::add_design_derivative(const State& state, ConstraintLevel level,
                                          Eigen::MatrixXd& columns) {
  state_.set(map_, state);
  inner_columns_.setZero(residual_.size(), columns.cols());
  inner_->add_design_derivative(state_.local, level, inner_columns_);
  if (!map_.derivatives.empty()) add_moving_map(level, columns);
  const Eigen::MatrixXd projected = map_.rows.transpose() * inner_columns_.topRows(locals());
  for (int i = 0; i < map_.columns(); ++i) {
    columns.row(map_.coordinates[i]) += projected.row(i);
  }
  for (int i = 0; i < multipliers(); ++i) {
    columns.row(row_of_multiplier(i)) += inner_columns_.row(locals() + i);
  }
}

void ProjectedTerm::linearize_inner(ConstraintLevel level) {
  static constexpr std::array<Weights, 3> weights{{{.q = 1.0}, {.v = 1.0}, {.a = 1.0}}};
  prepare(weights.size());
  residual_.setZero();
  inner_->linearize(state_.local, weights, level, residual_,
                    {values_.data(), static_cast<std::ptrdiff_t>(inner_entries_.size())});
}

/// The design moves the local coordinates at given generalized ones, and turns the projection.
void ProjectedTerm::add_moving_map(ConstraintLevel level, Eigen::MatrixXd& columns) {
  linearize_inner(level);
  const std::array<const Eigen::VectorXd*, 3> parts{&state_.q, &state_.v, &state_.a};
  for (const auto& [variable, rows] : map_.derivatives) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      set_tangent(i);
      inner_columns_.col(variable) += tangent_.leftCols(locals()) * (rows * *parts[i]);
    }
    const Eigen::VectorXd turned = rows.transpose() * residual_.head(locals());
    for (int i = 0; i < map_.columns(); ++i) {
      columns(map_.coordinates[i], variable) += turned(i);
    }
  }
}

void ProjectedTerm::add_parameter_adjoints(const State& state, ConstraintLevel level,
                                           const ConstColumns& mu, Columns sums) {
  if (sums.rows() == 0) return;
  state_.set(map_, state);
  inner_mu_.resize(residual_.size(), mu.cols());
  inner_mu_.topRows(locals()).noalias() = map_.rows * mu(map_.coordinates, Eigen::all);
  for (int i = 0; i < multipliers(); ++i) {
    inner_mu_.row(locals() + i) = mu.row(row_of_multiplier(i));
  }
  inner_->add_parameter_adjoints(state_.local, level, inner_mu_,
                                 sums.topRows(inner_->parameter_adjoint_count()));
  if (!map_.derivatives.empty()) add_map_sums(level, mu, sums.bottomRows(map_sum_count()));
}

/// The matrix that P_x is multiplied with, by columns.
void ProjectedTerm::add_map_sums(ConstraintLevel level, const ConstColumns& mu, Columns sums) {
  linearize_inner(level);
  const std::array<const Eigen::VectorXd*, 3> parts{&state_.q, &state_.v, &state_.a};
  const auto factor = [&](Eigen::Index i) {
    return Eigen::Map<Eigen::MatrixXd>(sums.col(i).data(), locals(), map_.columns());
  };
  for (Eigen::Index i = 0; i < mu.cols(); ++i) {
    factor(i) += residual_.head(locals()) * mu.col(i)(map_.coordinates).transpose();
  }
  for (std::size_t part = 0; part < parts.size(); ++part) {
    set_tangent(part);
    const Eigen::MatrixXd forces = tangent_.leftCols(locals()).transpose() * inner_mu_;
    for (Eigen::Index i = 0; i < mu.cols(); ++i) {
      factor(i) += forces.col(i) * parts[part]->transpose();
    }
  }
}

void ProjectedTerm::add_design_gradients(const ConstColumns& sums,
                                         Eigen::MatrixXd& gradients) const {
  inner_->add_design_gradients(sums.topRows(inner_->parameter_adjoint_count()), gradients);
  for (const auto& [variable, rows] : map_.derivatives) {
    const Eigen::Map<const Eigen::VectorXd> flat(rows.data(), rows.size());
    gradients.row(variable) += flat.transpose() * sums.bottomRows(map_sum_count());
  }
}

}  // namespace pleuel
