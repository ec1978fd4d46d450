#include "tests/reduction/solid_block.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "tests/support/dense_algebra.hpp"

namespace pleuel::test {

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;
using Place = std::array<int, 3>;  ///< on a grid of half elements

/// Corners, then middles of edges, as CalculiX counts them, in halves of the element.
constexpr std::array<Place, 20> nodes = {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2},
                                          {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0},
                                          {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2},
                                          {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}}};

/// Powers of x, y and z whose sum without those of first order is two at most: 20 of them.
std::vector<Place> serendipity_powers() {
  std::vector<Place> powers;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        const int superlinear = (i > 1 ? i : 0) + (j > 1 ? j : 0) + (k > 1 ? k : 0);
        if (superlinear < 3) powers.push_back({i, j, k});
      }
    }
  }
  return powers;
}

double power(double x, int n) {
  return n == 0 ? 1.0 : n == 1 ? x : x * x;
}

double power_derivative(double x, int n) {
  return n == 0 ? 0.0 : n == 1 ? 1.0 : 2.0 * x;
}

Eigen::VectorXd monomials(const Eigen::Vector3d& x) {
  Eigen::VectorXd values(20);
  int row = 0;
  for (const auto& [i, j, k] : serendipity_powers()) {
    values(row++) = power(x(0), i) * power(x(1), j) * power(x(2), k);
  }
  return values;
}

/// Functions from monomials: one at its node, zero at the others.
const Eigen::MatrixXd& coefficients() {
  static const Eigen::MatrixXd matrix = [] {
    Eigen::MatrixXd vandermonde(20, 20);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d at(nodes[i][0] - 1.0, nodes[i][1] - 1.0, nodes[i][2] - 1.0);
      vandermonde.col(i) = monomials(at);
    }
    return solve_dense(vandermonde, Eigen::MatrixXd::Identity(20, 20));
  }();
  return matrix;
}

Eigen::MatrixXd hooke(const Block& block) {
  const double nu = block.poisson, c = block.young / ((1.0 + nu) * (1.0 - 2.0 * nu));
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(6, 6);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) d(i, j) = c * (i == j ? 1.0 - nu : nu);
    d(3 + i, 3 + i) = c * (0.5 - nu);
  }
  return d;
}

struct ElementMatrices {
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(60, 60);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(60, 60);
};

/// Of a brick; Gauss's rule of three points on each axis.
ElementMatrices brick(const Block& block, const Eigen::Vector3d& size) {
  ElementMatrices element;
  const Eigen::MatrixXd d = hooke(block);
  const std::array<std::pair<double, double>, 3> rule = {
      {{-std::sqrt(0.6), 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {std::sqrt(0.6), 5.0 / 9.0}}};
  for (const auto& [x, a] : rule) {
    for (const auto& [y, b] : rule) {
      for (const auto& [z, c] : rule) {
        const Eigen::Vector3d at(x, y, z);
        const Eigen::VectorXd n = monomial_functions(at);
        const Eigen::MatrixXd g =
            monomial_derivatives(at) * (2.0 / size.array()).matrix().asDiagonal();
        const double volume = a * b * c * size.prod() / 8.0;
        Eigen::MatrixXd strain = Eigen::MatrixXd::Zero(6, 60), shape = Eigen::MatrixXd::Zero(3, 60);
        for (int i = 0; i < 20; ++i) {
          for (int k = 0; k < 3; ++k) shape(k, 3 * i + k) = n(i);
          for (int k = 0; k < 3; ++k) strain(k, 3 * i + k) = g(i, k);
          strain(3, 3 * i) = g(i, 1), strain(3, 3 * i + 1) = g(i, 0);
          strain(4, 3 * i + 1) = g(i, 2), strain(4, 3 * i + 2) = g(i, 1);
          strain(5, 3 * i) = g(i, 2), strain(5, 3 * i + 2) = g(i, 0);
        }
        element.stiffness += volume * strain.transpose() * d * strain;
        element.mass += volume * block.density * shape.transpose() * shape;
      }
    }
  }
  return element;
}

std::string market(const Eigen::SparseMatrix<double>& matrix, double factor) {
  std::string text = "%%MatrixMarket matrix coordinate real symmetric\n% of a test\n";
  std::string entries;
  int count = 0;
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, j); entry; ++entry) {
      if (entry.row() < j) continue;
      entries += fmt::format("{} {} {:.17g}\n", entry.row() + 1, j + 1, factor * entry.value());
      ++count;
    }
  }
  return text + fmt::format("{} {} {}\n", matrix.rows(), matrix.cols(), count) + entries;
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::string end_set(const BlockModel& model, const std::string& name, double x) {
  std::string text = fmt::format("*NSET, NSET={}\n", name);
  for (int i = 0; i < model.positions.cols(); ++i) {
    if (std::abs(model.positions(0, i) - x) < 1e-9) text += fmt::format("{},\n", i + 1);
  }
  return text;
}

}  // namespace

Eigen::VectorXd monomial_functions(const Eigen::Vector3d& local) {
  return coefficients() * monomials(local);
}

Eigen::MatrixXd monomial_derivatives(const Eigen::Vector3d& x) {
  Eigen::MatrixXd derivatives(20, 3);
  int row = 0;
  for (const Place& powers : serendipity_powers()) {
    for (int k = 0; k < 3; ++k) {
      double value = 1.0;
      for (int l = 0; l < 3; ++l) {
        value *= l == k ? power_derivative(x(l), powers[l]) : power(x(l), powers[l]);
      }
      derivatives(row, k) = value;
    }
    ++row;
  }
  return coefficients() * derivatives;
}

BlockModel make_block(const Block& block) {
  const Eigen::Vector3d size(block.length / block.along, block.height / block.up,
                             block.width / block.across);
  std::map<Place, int> index;
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::array<int, 20>> elements;
  for (int i = 0; i < block.along; ++i) {
    for (int j = 0; j < block.up; ++j) {
      for (int k = 0; k < block.across; ++k) {
        auto& element = elements.emplace_back();
        for (int n = 0; n < 20; ++n) {
          const Place at = {2 * i + nodes[n][0], 2 * j + nodes[n][1], 2 * k + nodes[n][2]};
          const auto [place, is_new] = index.emplace(at, static_cast<int>(positions.size()));
          if (is_new) {
            positions.emplace_back(0.5 * at[0] * size(0), 0.5 * at[1] * size(1) - block.height / 2,
                                   0.5 * at[2] * size(2) - block.width / 2);
          }
          element[n] = place->second;
        }
      }
    }
  }
  const ElementMatrices one = brick(block, size);
  Entries stiffness, mass;
  BlockModel model;
  model.elements.resize(20, static_cast<int>(elements.size()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (int i = 0; i < 60; ++i) {
      model.elements(i / 3, static_cast<int>(e)) = elements[e][i / 3];
      for (int j = 0; j < 60; ++j) {
        const int row = 3 * elements[e][i / 3] + i % 3, column = 3 * elements[e][j / 3] + j % 3;
        stiffness.emplace_back(row, column, one.stiffness(i, j));
        if (i % 3 == j % 3) mass.emplace_back(row, column, one.mass(i, j));
      }
    }
  }
  model.positions.resize(3, static_cast<int>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    model.positions.col(static_cast<int>(i)) = positions[i];
  }
  const int rows = 3 * static_cast<int>(positions.size());
  model.stiffness.resize(rows, rows);
  model.mass.resize(rows, rows);
  model.stiffness.setFromTriplets(stiffness.begin(), stiffness.end());
  model.mass.setFromTriplets(mass.begin(), mass.end());
  return model;
}

std::string block_input(const Block& block, const BlockModel& model, const WrittenUnits& units) {
  std::string text = "*HEADING\n a block\n*NODE\n";
  for (int i = 0; i < model.positions.cols(); ++i) {
    const Eigen::Vector3d x = model.positions.col(i) / units.length;
    text += fmt::format("{}, {:.15g}, {:.15g}, {:.15g}\n", i + 1, x(0), x(1), x(2));
  }
  text += "*ELEMENT, TYPE=C3D20, ELSET=body\n";
  for (int e = 0; e < model.elements.cols(); ++e) {
    text += fmt::format("{}", e + 1);
    for (int i = 0; i < 20; ++i) {
      text += fmt::format(",{}{}", i == 10 ? "\n" : " ", model.elements(i, e) + 1);
    }
    text += "\n";
  }
  text += end_set(model, "left", 0.0) + end_set(model, "right", block.length);
  return text + fmt::format(
                    "*MATERIAL, NAME=steel\n*ELASTIC\n{:.17g}, {:.17g}\n*DENSITY\n{:.17g}\n"
                    "*SOLID SECTION, ELSET=body, MATERIAL=steel\n",
                    block.young / (units.mass / units.length / units.time / units.time),
                    block.poisson, block.density / (units.mass / std::pow(units.length, 3)));
}

std::filesystem::path write_block_model(const std::filesystem::path& folder, const Block& block,
                                        const BlockModel& model, const std::string& kind,
                                        const std::string& more, const WrittenUnits& units) {
  write(folder / "block.inp", block_input(block, model, units));
  write(folder / "K.mtx", market(model.stiffness, units.time * units.time / units.mass));
  write(folder / "M.mtx", market(model.mass, 1.0 / units.mass));
  write(folder / "model.json", fmt::format(R"({{"body": "block", "mesh": "block.inp", "units": "{}",
 "matrices": {{"stiffness": "K.mtx", "mass": "M.mtx"}},
 "interfaces": {{"left": {{"nodes": "left", "kind": "{}"}}, "right": {{"nodes": "RIGHT", "kind": "{}"}}}}{}}})",
                                           units.name, kind, kind, more));
  return folder / "model.json";
}

}  // namespace pleuel::test
