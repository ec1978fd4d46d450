#pragma once

#include <filesystem>
#include <string>

#include <Eigen/SparseCore>

/// A finite-element code of the tests' own: a block of hexahedra with 20 nodes, whose shape functions come
/// from their values at the nodes (monomials and the inverse of a Vandermonde matrix), not from the
/// formulas of reduction/element_shape.hpp.
namespace pleuel::test {

struct Block {
  double length = 0.4, height = 0.04, width = 0.03;  ///< along x, y, z; centred on the x axis [m]
  int along = 8, up = 2, across = 2;                 ///< elements
  double young = 2.1e11, poisson = 0.0, density = 7850.0;

  double area() const { return height * width; }
  double inertia_z() const { return width * height * height * height / 12.0; }
};

struct BlockModel {
  Eigen::Matrix3Xd positions;  ///< 3 × nodes
  Eigen::MatrixXi elements;    ///< 20 × elements, nodes from 0, in the order of CalculiX
  Eigen::SparseMatrix<double> stiffness, mass;  ///< 3 nodes × 3 nodes
};

BlockModel make_block(const Block& block);

/// Values of the 20 functions at a point of [−1, 1]³, and their derivatives, 20 × 3.
Eigen::VectorXd monomial_functions(const Eigen::Vector3d& local);
Eigen::MatrixXd monomial_derivatives(const Eigen::Vector3d& local);

/// Units that the files are written in.
struct WrittenUnits {
  std::string name = "m-kg-s";
  double length = 1.0, mass = 1.0, time = 1.0;  ///< SI values of one unit
};

/// Writes block.inp, K.mtx, M.mtx and model.json into a folder, with the sets LEFT and RIGHT.
/// @param more  members of model.json after "interfaces", such as ", \"modes\": 4"
/// @returns     the path of model.json
std::filesystem::path write_block_model(const std::filesystem::path& folder, const Block& block,
                                        const BlockModel& model, const std::string& kind,
                                        const std::string& more, const WrittenUnits& units = {});

/// The mesh and the material, as an input file of CalculiX.
std::string block_input(const Block& block, const BlockModel& model,
                        const WrittenUnits& units = {});

}  // namespace pleuel::test
