#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

/// An independent solution of Saint-Venant's torsion problem, to compare formulas with.
namespace pleuel::test {

/// What fills a cell of the grid.
enum class Fill { nothing, solid, hole };

/// Prandtl's stress function of a doubly symmetric section,
///     ∇²φ = −2 in the solid, φ = 0 on the outer boundary, φ constant over a hole,
///     J = 2 ∫φ dA (holes included), shear stress per torque at the boundary −(∂φ/∂n)/J,
/// by bilinear finite elements on the quarter y, z ≥ 0. The energy is minimal over the functions of
/// the grid, so that J is approached from below. Timoshenko & Goodier, Theory of Elasticity,
/// §§104–107, 115.
class SaintVenant {
 public:
  /// @param y, z  lines of the grid, ascending from 0; the last ones bound the section.
  /// @param fill  of the cell with this middle (y, z).
  SaintVenant(std::vector<double> y, std::vector<double> z,
              const std::function<Fill(double, double)>& fill);

  double constant() const { return constant_; }  ///< J [m⁴]

  /// Shear per torque on the side y = last line, by the second-order one-sided difference.
  double shear_at_top(double z) const;
  double shear_at_side(double y) const;  ///< on the side z = last line

 private:
  static Eigen::Index nearest(const std::vector<double>& lines, double place);

  std::vector<double> y_, z_;
  Eigen::MatrixXd phi_;
  double constant_ = 0.0;
};

struct GridStretch {
  double end;
  int cells;
};

/// Lines from 0 over the ends of the stretches, each evenly divided.
std::vector<double> grid_lines(const std::vector<GridStretch>& stretches);

/// The limit of values on grids of n, 2n and 4n cells, with the order that they show.
double extrapolated(double coarse, double middle, double fine);

}  // namespace pleuel::test
