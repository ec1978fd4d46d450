#include "core/beam/lateral_buckling.hpp"

#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/section/rectangle_section.hpp"
#include "core/section/round_section.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::lateral_buckling_test {
namespace {

constexpr double young = 2.1e11, shear = 8.0e10, length = 1.2;
constexpr int count = 16;
const double pi = std::numbers::pi;

/// So thin that 1 − EI/EI_bending is one to 1e-4.
Beam<double> thin_beam() {
  BeamElement<double> element{length / count, young, shear, 7850.0,
                              rectangle_section<double>(0.0005, 0.05)};
  Beam<double> beam;
  beam.elements.assign(count, element);
  return beam;
}

struct Ends {
  LateralSupport first, last;
};
constexpr LateralSupport clamped{true, true, true}, forked{true, false, true}, open{};

PlaneLoad load_of(double axial, const std::vector<double>& moments) {
  PlaneLoad load(4, count);
  for (int e = 0; e < count; ++e) load.col(e) << axial, axial, moments[e], moments[e + 1];
  return load;
}

double factor(const Ends& ends, double axial, const std::vector<double>& moments) {
  const Beam<double> beam = thin_beam();
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = ends.first;
  supports.back() = ends.last;
  return 1.0 / LateralBuckling(beam, BendingPlane::xy, supports).share(load_of(axial, moments));
}

double lateral_stiffness() {
  return young * thin_beam().elements[0].section.inertia_y;
}
double torsional_stiffness() {
  return shear * thin_beam().elements[0].section.torsion;
}
double pair_stiffness() {
  return std::sqrt(lateral_stiffness() * torsional_stiffness());
}

/// From x = 0 on, of one newton at the end, and constant.
std::vector<double> tip_force() {
  std::vector<double> moments;
  for (int i = 0; i <= count; ++i) moments.push_back(length * (1.0 - double(i) / count));
  return moments;
}
const std::vector<double> none(count + 1, 0.0), constant(count + 1, 1.0);

// Sixteen elements: 1e-5 in columns. Twist is linear in an element: (π/16)²/24 = 1.6e-3 for a half
// wave of it, less for a quarter.

TEST(LateralStability, OfAConstantMomentBetweenForksIsTheClosedForm) {
  EXPECT_NEAR(factor({forked, forked}, 0.0, constant) / (pi * pair_stiffness() / length), 1.0016,
              2e-4);
}

TEST(LateralStability, OfACantileverWithATipForceIsTheClosedForm) {
  const double critical = 4.0126 * pair_stiffness() / (length * length);
  EXPECT_NEAR(factor({clamped, open}, 0.0, tip_force()) / critical, 1.001, 2e-4);
}

TEST(LateralStability, DoesNotDependOnTheSenseOfBending) {
  std::vector<double> opposite = tip_force();
  for (double& moment : opposite) moment = -moment;
  EXPECT_NEAR(factor({clamped, open}, 0.0, opposite) / factor({clamped, open}, 0.0, tip_force()),
              1.0, 1e-9);
}

TEST(LateralStability, OfColumnsIsTheEulerLoadOfTheirEnds) {
  const double unit = pi * pi * lateral_stiffness() / (length * length);
  EXPECT_NEAR(factor({clamped, open}, -1.0, none) / (unit / 4), 1.0, 1e-4);
  EXPECT_NEAR(factor({forked, forked}, -1.0, none) / unit, 1.0, 1e-4);
  EXPECT_NEAR(factor({clamped, clamped}, -1.0, none) / (4 * unit), 1.0, 1e-4);
  EXPECT_NEAR(factor({clamped, forked}, -1.0, none) / (2.045748 * unit), 1.0, 1e-4);
  EXPECT_TRUE(std::isinf(factor({forked, forked}, 1.0, none))) << "pull";
}

/// A column of two sections, clamped below and free above: by the solutions of EI u'' = −P u on
/// both parts, tan(k₁ l₁) tan(k₂ l₂) = k₂/k₁ with k² = P/EI (Timoshenko & Gere, Theory of Elastic
/// Stability, §2.14).
TEST(LateralStability, OfASteppedColumnIsTheRootOfItsEquation) {
  Beam<double> beam = thin_beam();
  for (int i = 0; i < 6; ++i) {  // 450 mm of 1200 mm
    beam.elements[i].section = rectangle_section<double>(0.0008, 0.05);
  }
  const double below = 6 * length / count, above = length - below;
  const double thick = young * beam.elements.front().section.inertia_y,
               thin = young * beam.elements.back().section.inertia_y;
  const auto open_equation = [&](double load) {
    const double k1 = std::sqrt(load / thick), k2 = std::sqrt(load / thin);
    return std::tan(k1 * below) * std::tan(k2 * above) - k2 / k1;
  };
  // Bisection below the first pole, where k₂ l₂ is a right angle.
  double low = 0.0, high = thin * std::pow(pi / 2 / above, 2) * (1 - 1e-12);
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (open_equation(middle) < 0.0 ? low : high) = middle;
  }
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = clamped;
  LateralBuckling buckling(beam, BendingPlane::xy, supports);
  EXPECT_NEAR(1.0 / buckling.share(load_of(-1.0, none)) / low, 1.0, 1e-4);
  // Between those of its two sections.
  EXPECT_GT(low, 1.2 * pi * pi * thin / (4 * length * length));
}

/// The critical load of a column of `elements` that shear bends, too.
/// @param compliance  1/(κGA) [1/N]
double sheared_load(const Ends& ends, int elements, double compliance) {
  Beam<double> beam = thin_beam();
  beam.elements.resize(elements, beam.elements.front());
  for (BeamElement<double>& element : beam.elements) {
    element.length = length / elements;
    element.shear_compliance_z = compliance;
    element.shear_compliance_y = 1e3 * compliance;  // of the plane of bending
  }
  std::vector<LateralSupport> supports(elements + 1);
  supports.front() = ends.first;
  supports.back() = ends.last;
  const PlaneLoad press = Eigen::Vector4d(-1.0, -1.0, 0.0, 0.0).replicate(1, elements);
  return 1.0 / LateralBuckling(beam, BendingPlane::xy, supports).share(press);
}

/// Engesser's P/(1 + P/(κGA)) with the load P without shear, where nothing but the axial force acts
/// across the sections (Timoshenko & Gere, Theory of Elastic Stability, art. 2.17). The shear angle
/// is constant in an element: the error falls with the square of its length.
TEST(LateralStability, OfAColumnThatShearsIsEngessersLoad) {
  for (const auto& [ends, share_of_unit] :
       {std::pair(Ends{clamped, open}, 0.25), std::pair(Ends{forked, forked}, 1.0),
        std::pair(Ends{clamped, clamped}, 4.0)}) {
    const double euler = share_of_unit * pi * pi * lateral_stiffness() / (length * length);
    for (const double softness : {0.1, 1.0, 10.0}) {
      SCOPED_TRACE(share_of_unit);
      const double expected = euler / (1.0 + softness);
      const double coarse = sheared_load(ends, 32, softness / euler);
      const double fine = sheared_load(ends, 64, softness / euler);
      EXPECT_NEAR((coarse - expected) / (fine - expected), 4.0, 0.1) << softness;
      EXPECT_NEAR((4.0 * fine - coarse) / 3.0, expected, 1e-5 * expected) << softness;
    }
  }
}

TEST(LateralStability, IsNotAskedForOfABeamThatNothingHolds) {
  const Beam<double> beam = thin_beam();
  std::vector<LateralSupport> supports(count + 1);
  EXPECT_FALSE(LateralBuckling(beam, BendingPlane::xy, supports).is_held());
  supports.front() = {true, false, false};
  EXPECT_FALSE(LateralBuckling(beam, BendingPlane::xy, supports).is_held()) << "a pin";
  supports.back() = supports.front();
  EXPECT_TRUE(LateralBuckling(beam, BendingPlane::xy, supports).is_held())
      << "it turns about its axis only";
}

/// A hanging column under its own weight, q = 7.837 EI/L³ (Timoshenko & Gere, §2.12): N is linear.
TEST(LateralStability, OfAColumnUnderItsWeightIsTheRootOfItsBesselFunction) {
  PlaneLoad load = PlaneLoad::Zero(4, count);
  for (int e = 0; e < count; ++e) {
    load(0, e) = -length * (count - e) / count;
    load(1, e) = -length * (count - e - 1) / count;
  }
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = clamped;
  LateralBuckling buckling(thin_beam(), BendingPlane::xy, supports);
  const double critical = 7.8373 * lateral_stiffness() / std::pow(length, 3);
  EXPECT_NEAR(1.0 / buckling.share(load) / critical, 1.0, 1e-4);
}

/// A moment and a force on forked ends: (M/M_cr)² = (1 − P/P_E)(1 − P/P_T) with P_T = GJ A/I₀
/// (Timoshenko & Gere, §5.1 and 6.2).
TEST(LateralStability, OfAForceAndAMomentIsTheirInteraction) {
  const SectionProperties<double> s = thin_beam().elements[0].section;
  const double euler = pi * pi * lateral_stiffness() / (length * length);
  const double torsional = torsional_stiffness() * s.area / (s.inertia_y + s.inertia_z);
  for (const double share : {-2.0, 0.3, 0.8}) {  // of Euler's load; the first pulls
    const double press = share * euler;
    const double moment = pi * pair_stiffness() / length *
                          std::sqrt((1.0 - press / euler) * (1.0 - press / torsional));
    const std::vector<double> moments(count + 1, moment);
    EXPECT_NEAR(factor({forked, forked}, -press, moments), 1.0, 3e-3) << share;
  }
}

/// The root of a function that rises between two numbers.
template <class Function>
double root(double low, double high, const Function& f) {
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) < 0.0 ? low : high) = middle;
  }
  return low;
}

double factor_with(const Ends& ends, const RigidEnds& rigid) {
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = ends.first;
  supports.back() = ends.last;
  LateralBuckling buckling(thin_beam(), BendingPlane::xy, supports, rigid);
  return 1.0 / buckling.share(load_of(-1.0, none));
}

/// A strut with rigid eyes of the length d at both ends, pinned at their tips: w = A cos kx from the
/// middle, w + d w' = 0 at x = L/2, so u tan u = L/2d with u = kL/2. Eyes that reach back have d < 0.
TEST(LateralStability, OfAStrutBetweenRigidEyesIsTheRootOfItsEquation) {
  for (const double share : {1e-4, 0.05, 0.09, 0.12, 0.5, 3.0, -0.1}) {
    const double d = share * length;
    const double low = d > 0.0 ? 0.0 : pi / 2;
    const double u = root(low, low + pi / 2, [&](double at) {
      return 2 * d * at * std::sin(at) - length * std::cos(at);
    });
    const double critical = std::pow(2 * u / length, 2) * lateral_stiffness();
    EXPECT_NEAR(factor_with({forked, forked}, {{{d, d}, {d, d}}}) / critical, 1.0, 1e-4) << share;
  }
}

/// A clamped column with a rigid body on top, the force at the distance d above the tip:
/// w = δ (1 − cos kx) and w + d w' = δ at x = L, so u tan u = L/d with u = kL.
TEST(LateralStability, OfAColumnUnderARigidBodyIsTheRootOfItsEquation) {
  for (const double share : {1e-4, 0.5, 1.0, 10.0}) {
    const double d = share * length;
    const double u =
        root(0.0, pi / 2, [&](double at) { return d * at * std::sin(at) - length * std::cos(at); });
    const double critical = std::pow(u / length, 2) * lateral_stiffness();
    EXPECT_NEAR(factor_with({clamped, open}, {{{}, {d, 0.0}}}) / critical, 1.0, 1e-4) << share;
    EXPECT_NEAR(factor_with({open, clamped}, {{{d, 0.0}, {}}}) / critical, 1.0, 1e-4) << share;
    EXPECT_NEAR(factor_with({clamped, open}, {{{}, {d, 0.3}}}) / critical, 1.0, 1e-4)
        << "what nothing holds has no pivot";
  }
}

/// A force across and a press at the tip of a rigid body on a cantilever: as of a beam whose last
/// elements are 1e5 times as stiff.
TEST(LateralStability, OfARigidEndIsThatOfAVeryStiffOne) {
  constexpr int stiff = 4;
  const double d = stiff * length / count;
  Beam<double> longer = thin_beam();
  for (int i = 0; i < stiff; ++i) {
    longer.elements.push_back(longer.elements.front());
    longer.elements.back().young *= 1e5;
    longer.elements.back().shear *= 1e5;
  }
  PlaneLoad load(4, count + stiff);
  for (int e = 0; e < count + stiff; ++e) {
    const double begin = length / count * e, end = begin + length / count;
    load.col(e) << -2.0, -2.0, length + d - begin, length + d - end;
  }
  for (const LateralSupport& last : {open, LateralSupport{true, false, false}}) {
    std::vector<LateralSupport> supports(count + stiff + 1);
    supports.front() = clamped;
    supports.back() = last;
    const double expected = LateralBuckling(longer, BendingPlane::xy, supports).share(load);
    supports.resize(count + 1);
    supports.back() = last;
    LateralBuckling rigid(thin_beam(), BendingPlane::xy, supports, {{{}, {d, d}}});
    EXPECT_NEAR(rigid.share(load.leftCols(count)) / expected, 1.0, 1e-4);
  }
}

/// Of unequal sections, any section forces and supports.
class AnyBeam : public testing::TestWithParam<int> {
 protected:
  AnyBeam() : supports(elements + 1), load(4, elements) {
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int e = 0; e < elements; ++e) {
      sizes.push_back(0.01 + 0.004 * number(random));
      for (int k = 0; k < 2; ++k) load(k, e) = 1e4 * (number(random) - 0.2 * (GetParam() % 3));
      for (int k = 2; k < 4; ++k) load(k, e) = 1e3 * number(random);
    }
    supports.front() = GetParam() % 2 == 0 ? clamped : forked;
    supports[3].twist = GetParam() % 4 == 1;
    supports.back().deflection = GetParam() % 2 == 1;
  }

  /// @param size  its width is multiplied by this
  template <class Scalar>
  Beam<Scalar> beam(const Scalar& size) const {
    Beam<Scalar> made;
    for (int e = 0; e < elements; ++e) {
      made.elements.push_back({Scalar((0.1 + 0.01 * e) * size), Scalar(young), Scalar(shear),
                               Scalar(7850.0),
                               rectangle_section<Scalar>(Scalar(sizes[e] * size), Scalar(0.05))});
      if (GetParam() < 6) continue;  // shear bends the others, by some tenths
      made.elements.back().shear_compliance_z = (1.0 + 0.1 * e) * 1e-5 / (size * size);
    }
    return made;
  }
  LateralBuckling buckling(double size = 1.0, const RigidEnds& ends = {}) const {
    return {beam<double>(size), BendingPlane::xy, supports, ends};
  }

  static constexpr int elements = 7;
  std::vector<double> sizes;
  std::vector<LateralSupport> supports;
  PlaneLoad load;
};

/// Differences of fourth order at the best of three steps: where another mode is near, slopes change
/// fast. 1e-8 of their noise.
template <class Function>
void expect_slope(double slope, double size, const Function& f) {
  double best = 1e300;
  for (const double h : {1e-3, 2e-4, 4e-5}) {
    const double difference = (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12.0 * h);
    best = std::min(best, std::abs(difference - slope));
  }
  EXPECT_LT(best, 1e-8 * size);
}

TEST_P(AnyBeam, HasTheSlopesOfDifferences) {
  LateralBuckling at = buckling();
  const LateralModes modes = at.modes(load);
  ASSERT_GT(modes.share, 1e-3);
  ASSERT_EQ(modes.shapes.cols(), 1);
  const PlaneLoad slopes = at.load_slopes(modes);
  const double scale = load.lpNorm<Eigen::Infinity>();
  for (Eigen::Index i = 0; i < load.size(); ++i) {
    SCOPED_TRACE(i);
    expect_slope(scale * slopes.reshaped()(i), modes.share, [&](double h) {
      PlaneLoad moved = load;
      moved.reshaped()(i) += h * scale;
      return at.share(moved);
    });
  }
  const Dual seeded(1.0, Dual::Derivatives::Ones());
  expect_slope(at.design_slope(beam<Dual>(seeded), load, modes), modes.share,
               [&](double h) { return buckling(1.0 + h).share(load); });
  // The share is linear in the load, as a whole (Euler's theorem).
  EXPECT_NEAR(slopes.cwiseProduct(load).sum(), modes.share, 1e-10 * modes.share);
}

TEST_P(AnyBeam, HasTheSlopesOfDifferencesOfItsRigidEnds) {
  const RigidEnds ends = {{{0.15, 0.04}, {0.2, 0.07}}};
  LateralBuckling at = buckling(1.0, ends);
  const LateralModes modes = at.modes(load);
  ASSERT_GT(modes.share, 1e-3);
  ASSERT_EQ(modes.shapes.cols(), 1);
  const RigidEnds slopes = at.end_slopes(load, modes);
  for (std::size_t end = 0; end < 2; ++end) {
    SCOPED_TRACE(end);
    const auto share_moved = [&](double RigidEnd::*distance) {
      return [&, distance](double h) {
        RigidEnds moved = ends;
        moved[end].*distance += 0.1 * h;
        return buckling(1.0, moved).share(load);
      };
    };
    expect_slope(0.1 * slopes[end].reach, modes.share, share_moved(&RigidEnd::reach));
    expect_slope(0.1 * slopes[end].pivot, modes.share, share_moved(&RigidEnd::pivot));
  }
  const Dual seeded(1.0, Dual::Derivatives::Ones());
  expect_slope(at.design_slope(beam<Dual>(seeded), load, modes), modes.share,
               [&](double h) { return buckling(1.0 + h, ends).share(load); });
  EXPECT_NEAR(at.load_slopes(modes).cwiseProduct(load).sum(), modes.share, 1e-10 * modes.share);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AnyBeam, testing::Range(0, 12), named_by_value());

/// Pull, and bending of a beam that is as stiff sideways.
TEST(LateralStability, IsNoneWhereNothingBuckles) {
  Beam<double> round = thin_beam();
  for (auto& element : round.elements) element.section = ellipse_section<double>(0.02, 0.02);
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = clamped;
  LateralBuckling buckling(round, BendingPlane::xy, supports);
  for (const PlaneLoad& load : {load_of(0.0, tip_force()), load_of(1e3, tip_force()),
                                load_of(1e3, none), load_of(0.0, none)}) {
    const LateralModes modes = buckling.modes(load);
    EXPECT_EQ(modes.share, 0.0);
    EXPECT_EQ(buckling.load_slopes(modes), PlaneLoad::Zero(4, count));
  }
}

/// Two halves of a beam that is held in the middle buckle alike, each for itself: the share has a kink,
/// and the mean of both slopes is the same for both.
TEST(LateralStability, OfTwoEqualSpansHasTheMeanOfTheirSlopes) {
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = supports.back() = supports[count / 2] = clamped;
  LateralBuckling buckling(thin_beam(), BendingPlane::xy, supports);
  const LateralModes modes = buckling.modes(load_of(-1.0, none));
  ASSERT_EQ(modes.shapes.cols(), 2);
  const PlaneLoad slopes = buckling.load_slopes(modes);
  for (int e = 0; e < count / 2; ++e) {
    EXPECT_NEAR(slopes(0, e) / slopes(0, e + count / 2), 1.0, 1e-6) << e;
  }
  EXPECT_NEAR(slopes.topRows<2>().sum(), -modes.share, 1e-9 * modes.share);
}

}  // namespace
}  // namespace pleuel::test::lateral_buckling_test
