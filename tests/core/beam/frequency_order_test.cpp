#include "tests/support/convergence.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::frequency_order_test {
namespace {

/// Error of λ falls with ℓ⁴ for cubic elements (Strang & Fix 1973); exact roots.
TEST(BeamFrequencyOrder, BendingErrorFallsWithTheFourthPowerOfTheElementLength) {
  std::vector<double> sizes, first, second;
  for (int elements : {4, 8, 16}) {
    const auto beam = uniform_beam(elements, 1.0, rectangle_section(0.02, 0.03), 2.1e11, 7850.0);
    const auto omega = frequencies(beam_invariants(
        beam, tangent_coordinates(elements + 1, bending_y), RotaryInertia::neglected));
    const double unit = std::sqrt(2.1e11 * 0.03 * 0.03 / 12 / 7850);
    sizes.push_back(1.0 / elements);
    first.push_back(std::abs(omega(0) / unit - 3.516015268500151));
    second.push_back(std::abs(omega(1) / unit - 22.034491564666766));
  }
  EXPECT_NEAR(observed_order(sizes, first), 4.0, 0.1);
  EXPECT_NEAR(observed_order(sizes, second), 4.0, 0.1);
}

TEST(BeamFrequencyOrder, AxialErrorFallsWithTheSquareOfTheElementLength) {
  std::vector<double> sizes, errors;
  for (int elements : {4, 8, 16}) {
    const auto beam = uniform_beam(elements, 1.0, rectangle_section(0.02, 0.03), 2.1e11, 7850.0);
    const auto omega =
        frequencies(beam_invariants(beam, tangent_coordinates(elements + 1, axial_only)));
    sizes.push_back(1.0 / elements);
    errors.push_back(std::abs(omega(0) - std::numbers::pi / 2 * std::sqrt(2.1e11 / 7850)));
  }
  EXPECT_NEAR(observed_order(sizes, errors), 2.0, 0.05);
}

}  // namespace
}  // namespace pleuel::test::frequency_order_test
