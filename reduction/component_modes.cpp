#include "reduction/component_modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "reduction/fixed_modes.hpp"
#include "reduction/nodal_invariants.hpp"
#include "reduction/symmetric_solver.hpp"

namespace pleuel {

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

/// Rigid interface of each node, −1 for others.
std::vector<int> rigid_owners(const std::vector<InterfaceSet>& interfaces, int nodes) {
  std::vector<int> owners(nodes, -1), seen(nodes, -1);
  for (int f = 0; f < int_size(interfaces); ++f) {
    for (const int node : interfaces[f].nodes) {
      if (seen[node] >= 0) {
        throw InputError(fmt::format("the interfaces \"{}\" and \"{}\" share nodes",
                                     interfaces[seen[node]].name, interfaces[f].name));
      }
      seen[node] = f;
      if (interfaces[f].is_rigid) owners[node] = f;
    }
  }
  return owners;
}

/// u = T [q of interfaces (six each; zero columns of those that are not rigid); u of free nodes].
class HeldBody {
 public:
  HeldBody(const SolidMatrices& matrices, const Eigen::Matrix3Xd& positions,
           const std::vector<InterfaceSet>& interfaces)
      : interfaces_(interfaces), prescribed_(6 * int_size(interfaces)) {
    set_transformation(positions);
    const SolidMatrix stiffness =
        transformation_.transpose() * matrices.stiffness * transformation_;
    const SolidMatrix mass = transformation_.transpose() * matrices.mass * transformation_;
    free_ = int_size(stiffness.diagonal()) - prescribed_;
    coupling_ = Eigen::MatrixXd(stiffness.bottomLeftCorner(free_, prescribed_));
    stiffness_ = stiffness.bottomRightCorner(free_, free_);
    mass_ = mass.bottomRightCorner(free_, free_);
    set_means(positions);
    factorize();
  }

  /// Displacements of the free nodes for loads on them and prescribed mean motions.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& loads, const Eigen::MatrixXd& means) const {
    Eigen::MatrixXd b(free_ + means_.rows(), loads.cols());
    b << loads, scale_ * means;
    return solver_->solve(b).topRows(free_);
  }

  /// Static displacements of all nodes for a coordinate of an interface.
  Eigen::MatrixXd constraint_modes(int interface) const {
    Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(free_, 6);
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(means_.rows(), 6);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(prescribed_ + free_, 6);
    if (interfaces_[interface].is_rigid) {
      loads = -coupling_.middleCols<6>(6 * interface);
      all.middleRows<6>(6 * interface).setIdentity();
    } else {
      means.middleRows<6>(first_mean_[interface]).setIdentity();
    }
    all.bottomRows(free_) = solve(loads, means);
    return transformation_ * all;
  }

  LowestModes fixed_modes(int count) const {
    return of_all_nodes(
        lowest_modes(statics(), mass_, std::min(count, free_ - int_size(means_.col(0)))));
  }

  LowestModes responses(const Eigen::Matrix3Xd& positions, int generations) const {
    InterfaceSet all{"", {}, positions.rowwise().mean(), true};
    for (int node = 0; node < int_size(column_); ++node) all.nodes.push_back(node);
    const Eigen::MatrixXd rows = rigid_rows(all, positions);
    Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(free_, 6);
    for (int node = 0; node < int_size(column_); ++node) {
      const int column = column_[node] - prescribed_;
      if (column >= 0) rigid.middleRows<3>(column) = rows.middleRows<3>(3 * node);
    }
    return of_all_nodes(inertia_responses(statics(), stiffness_, mass_, rigid, generations));
  }

 private:
  StaticSolution statics() const {
    return [this](const Eigen::MatrixXd& load) -> Eigen::MatrixXd {
      return solve(load, Eigen::MatrixXd::Zero(means_.rows(), load.cols()));
    };
  }

  LowestModes of_all_nodes(LowestModes modes) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(prescribed_ + free_, modes.shapes.cols());
    all.bottomRows(free_) = modes.shapes;
    modes.shapes = transformation_ * all;
    return modes;
  }

  void set_transformation(const Eigen::Matrix3Xd& positions) {
    const int nodes = static_cast<int>(positions.cols());
    const std::vector<int> owners = rigid_owners(interfaces_, nodes);
    Entries entries;
    for (int f = 0; f < int_size(interfaces_); ++f) {
      if (interfaces_[f].is_rigid) add_rigid(entries, f, positions);
    }
    column_.assign(nodes, -1);
    int column = prescribed_;
    for (int node = 0; node < nodes; ++node) {
      if (owners[node] >= 0) continue;
      column_[node] = column;
      for (int k = 0; k < 3; ++k) entries.emplace_back(3 * node + k, column++, 1.0);
    }
    transformation_.resize(3 * nodes, column);
    transformation_.setFromTriplets(entries.begin(), entries.end());
  }

  void add_rigid(Entries& entries, int f, const Eigen::Matrix3Xd& positions) const {
    const Eigen::MatrixXd rows = rigid_rows(interfaces_[f], positions);
    for (int i = 0; i < int_size(rows.col(0)); ++i) {
      const int row = 3 * interfaces_[f].nodes[i / 3] + i % 3;
      for (int k = 0; k < 6; ++k) {
        if (rows(i, k) != 0.0) entries.emplace_back(row, 6 * f + k, rows(i, k));
      }
    }
  }

  /// A of the interfaces that are not rigid.
  void set_means(const Eigen::Matrix3Xd& positions) {
    Entries entries;
    int row = 0;
    first_mean_.assign(interfaces_.size(), -1);
    for (int f = 0; f < int_size(interfaces_); ++f) {
      if (interfaces_[f].is_rigid) continue;
      const Eigen::MatrixXd rows = mean_rows(interfaces_[f], positions);
      for (int k = 0; k < 6; ++k) {
        for (int i = 0; i < int_size(rows.row(0)); ++i) {
          const int column = column_[interfaces_[f].nodes[i / 3]] + i % 3 - prescribed_;
          entries.emplace_back(row + k, column, rows(k, i));
        }
      }
      first_mean_[f] = row;
      row += 6;
    }
    means_.resize(row, free_);
    means_.setFromTriplets(entries.begin(), entries.end());
  }

  /// The multipliers are scaled as the stiffness is: pivots of A alone would look like zeros.
  void factorize() {
    scale_ = stiffness_.diagonal().cwiseAbs().maxCoeff();
    Entries entries;
    for (int j = 0; j < free_; ++j) {
      for (SolidMatrix::InnerIterator entry(stiffness_, j); entry; ++entry) {
        if (entry.row() >= j) entries.emplace_back(entry.row(), j, entry.value());
      }
      for (SolidMatrix::InnerIterator entry(means_, j); entry; ++entry) {
        entries.emplace_back(free_ + entry.row(), j, scale_ * entry.value());
      }
    }
    const int size = free_ + static_cast<int>(means_.rows());
    SolidMatrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_ = std::make_unique<SymmetricSolver>(matrix);
    if (solver_->null_pivots() > 0) {
      throw InputError(fmt::format(
          "with all interfaces held the body can still move in {} ways: a part of it is connected "
          "to no interface, or hangs on a single node or edge",
          solver_->null_pivots()));
    }
    if (solver_->negative_pivots() > means_.rows()) {
      throw InputError(
          "the stiffness matrix is not positive: an element is inside out, or the "
          "matrices are not those of this mesh");
    }
  }

  const std::vector<InterfaceSet>& interfaces_;
  int prescribed_, free_ = 0;
  std::vector<int> column_, first_mean_;
  SolidMatrix transformation_, stiffness_, mass_, means_;
  Eigen::MatrixXd coupling_;
  double scale_ = 1.0;
  std::unique_ptr<SymmetricSolver> solver_;
};

/// So many that one more than asked for is known.
LowestModes wanted_modes(const HeldBody& body, const Eigen::Matrix3Xd& positions,
                         const ModeCount& modes) {
  if (modes.generations > 0) return body.responses(positions, modes.generations);
  int count = modes.frequency > 0.0 ? 8 : modes.number + 1;
  LowestModes found = body.fixed_modes(count);
  while (modes.frequency > 0.0 && int_size(found.squares) == count &&
         std::sqrt(found.squares(count - 1)) < modes.frequency) {
    count *= 2;
    found = body.fixed_modes(count);
  }
  return found;
}

int kept_modes(const LowestModes& found, const ModeCount& modes) {
  if (modes.generations > 0) return int_size(found.squares);
  if (!(modes.frequency > 0.0)) return std::min(modes.number, int_size(found.squares));
  const double most = modes.frequency * modes.frequency;
  return static_cast<int>((found.squares.array() < most).count());
}

/// The largest displacement of a mode is positive: a sign that a small change of the body keeps.
void set_signs(Eigen::MatrixXd& shapes) {
  for (Eigen::Index j = 0; j < shapes.cols(); ++j) {
    Eigen::Index largest = 0;
    shapes.col(j).cwiseAbs().maxCoeff(&largest);
    if (shapes(largest, j) < 0.0) shapes.col(j) *= -1.0;
  }
}

}  // namespace

ComponentModes component_modes(const SolidMatrices& matrices, const Eigen::Matrix3Xd& positions,
                               const std::vector<InterfaceSet>& interfaces,
                               const ModeCount& count) {
  constexpr std::array<const char*, 6> names = {"u", "v", "w", "rx", "ry", "rz"};
  const HeldBody body(matrices, positions, interfaces);
  LowestModes found = wanted_modes(body, positions, count);
  const int kept = kept_modes(found, count);
  const int prescribed = 6 * (int_size(interfaces) - 1);
  ComponentModes modes;
  modes.shape.resize(3 * positions.cols(), prescribed + kept);
  for (int f = 1; f < int_size(interfaces); ++f) {
    modes.shape.middleCols<6>(6 * (f - 1)) = body.constraint_modes(f);
    for (const char* name : names) {
      modes.names.push_back(fmt::format("{} of {}", name, interfaces[f].name));
    }
  }
  if (count.generations == 0) set_signs(found.shapes);
  modes.shape.rightCols(kept) = found.shapes.leftCols(kept);
  for (int i = 0; i < kept; ++i) {
    modes.names.push_back(fmt::format("{} {}", count.generations > 0 ? "response" : "mode", i + 1));
  }
  modes.frequencies = found.squares.head(kept).cwiseSqrt();
  if (int_size(found.squares) > kept) modes.next_frequency = std::sqrt(found.squares(kept));
  return modes;
}

}  // namespace pleuel
