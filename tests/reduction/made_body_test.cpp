#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "core/jobs/child_program.hpp"
#include "core/scene/aligned_body.hpp"
#include "core/scene/body_constants.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/continued_body.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::made_body_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using FilePointer = std::shared_ptr<const InvariantsFile>;

SparseMatrix sparse(const MatrixXd& matrix) {
  return matrix.sparseView(1.0, 0.0);
}

VectorXd values(double x) {
  return VectorXd::Constant(1, x);
}

/// A body of two coordinates with K = a x³ + b x² and the mass of a bar of height x; its derivatives by hand.
BodyConstants constants_at(double a, double b, double mass) {
  MatrixXd first(2, 2), second(2, 2), unit = MatrixXd::Identity(2, 2);
  first << 4e5, 1e3, 1e3, 9.0;
  second << 1e4, -200.0, -200.0, 7.0;
  BodyConstants body;
  body.mass = 2.0 * mass;
  body.first_moment = mass * Eigen::Vector3d::UnitX();
  body.second_moment = mass * Eigen::Matrix3d::Identity();
  body.shape = sparse((MatrixXd(3, 2) << 0.3 * mass, 0.0, 0.0, 0.8 * mass, 0.0, 0.0).finished());
  body.mixed = sparse(mass * MatrixXd::Constant(9, 2, 0.1));
  for (std::size_t i = 0; i < 6; ++i) body.moments[i] = sparse(i < 3 ? mass * unit : 0.0 * unit);
  body.mass_matrix = sparse(3.0 * mass * unit);
  body.stiffness = sparse(a * first + b * second);
  body.damping = sparse(1e-5 * (a * first + b * second));
  body.places = {{"end", Eigen::Vector3d::UnitX(), sparse(MatrixXd::Identity(3, 2)),
                  sparse(MatrixXd::Identity(3, 2))}};
  return body;
}

InvariantsFile body_of(double x, double second = 1.0) {
  InvariantsFile file;
  file.body = "bar";
  file.reference_condition = "clamped";
  file.coordinates = {"stretching", "bending"};
  file.constants = constants_at(std::pow(x, 3), second * x * x, x);
  BodyConstants change = constants_at(3.0 * x * x, second * 2.0 * x, 1.0);
  change.places[0].position.setZero();
  change.places[0].displacement.setZero();
  change.places[0].rotation.setZero();
  file.design = {{"height", x, "m", change}};
  return file;
}

std::shared_ptr<const BodySource> continued(const std::vector<double>& designs,
                                            double second = 1.0) {
  std::vector<FilePointer> files;
  for (const double x : designs) {
    files.push_back(std::make_shared<const InvariantsFile>(body_of(x, second)));
  }
  return continue_body("", files);
}

double difference(const SparseMatrix& a, const SparseMatrix& b) {
  return (MatrixXd(a) - MatrixXd(b)).cwiseAbs().maxCoeff() / MatrixXd(b).cwiseAbs().maxCoeff();
}

TEST(ContinuedBody, IsTheBodyThatWasMadeAtItsDesigns) {
  const auto source = continued({0.8, 1.0, 1.3});
  for (const double x : {0.8, 1.0, 1.3}) {
    EXPECT_EQ(
        difference(source->at(values(x))->constants.stiffness, body_of(x).constants.stiffness),
        0.0);
    EXPECT_EQ(source->distance(values(x)), 0.0);
  }
  EXPECT_NEAR(source->distance(values(0.99)), 0.01, 1e-12);
}

/// Beside a design values differ by the square of the distance, and derivatives by the distance: 1e-4.
TEST(ContinuedBody, HasValuesAndDerivativesOfItsDesigns) {
  const auto source = continued({0.8, 1.0, 1.3});
  for (const double x : {0.8, 1.0, 1.3}) {
    const FilePointer beside = source->at(values(x * (1.0 + 1e-4)));
    const InvariantsFile exact = body_of(x * (1.0 + 1e-4));
    EXPECT_LT(difference(beside->constants.stiffness, exact.constants.stiffness), 1e-7);
    EXPECT_LT(
        difference(beside->design[0].derivative->stiffness, exact.design[0].derivative->stiffness),
        1e-3);
  }
}

/// Central differences of the continued values; their error is h² times a third derivative.
TEST(ContinuedBody, DerivativesBetweenDesignsAreThoseOfItsValues) {
  const auto source = continued({0.8, 1.0, 1.3});
  constexpr double h = 1e-5;
  for (const double x : {0.7, 0.93, 1.1, 1.6}) {
    BodyConstants slope = zero_constants(source->at(values(x))->constants);
    add_constants(slope, 0.5 / h, source->at(values(x + h))->constants);
    add_constants(slope, -0.5 / h, source->at(values(x - h))->constants);
    const FilePointer file = source->at(values(x));
    const BodyConstants& given = *file->design[0].derivative;
    EXPECT_LT(difference(given.stiffness, slope.stiffness), 1e-6) << x;
    EXPECT_LT(difference(given.damping, slope.damping), 1e-6) << x;
    EXPECT_LT(difference(given.mass_matrix, slope.mass_matrix), 1e-6) << x;
  }
}

/// With slopes of other designs its second derivatives are right to first order: beside a design the error
/// goes with the third power of the distance, where that of a tangent goes with the second.
TEST(ContinuedBody, FollowsTheBendThatSlopesOfOtherDesignsTell) {
  const auto error = [](const std::vector<double>& designs, double x) {
    return difference(continued(designs)->at(values(x))->constants.stiffness,
                      body_of(x).constants.stiffness);
  };
  EXPECT_LT(error({1.0}, 1.1), 3e-3);  // b x² beside a x³: not a line in logarithms
  EXPECT_LT(error({1.2, 1.0}, 1.05), 0.1 * error({1.0}, 1.05));
  EXPECT_LT(error({1.2, 1.0}, 1.1), 0.1 * error({1.0}, 1.1));
}

/// K ~ x³ is a line in logarithms: exact for any step, where a line in x itself is below zero at 1 − 0.4.
TEST(ContinuedBody, PowersAreContinuedExactly) {
  const auto source = continued({1.0}, 0.0);
  for (const double x : {0.3, 0.6, 2.0}) {
    EXPECT_LT(
        difference(source->at(values(x))->constants.stiffness, body_of(x, 0.0).constants.stiffness),
        1e-12);
  }
}

/// G = ∫ρ φ φᵀ of particles, whose displacements are x and x³ times two functions: positive at all x > 0, where a
/// line from 1 with the slope of x³ is negative below 2/3.
BodyConstants particles(double x) {
  BodyConstants body = constants_at(std::pow(x, 3), x * x, x);
  body = zero_constants(body);
  body.stiffness = constants_at(std::pow(x, 3), x * x, x).stiffness;
  body.damping = constants_at(std::pow(x, 3), x * x, x).damping;
  MatrixXd shape = MatrixXd::Zero(3, 2), mixed = MatrixXd::Zero(9, 2);
  std::array<MatrixXd, 6> moments;
  moments.fill(MatrixXd::Zero(2, 2));
  for (const double place : {0.1, 0.4, 0.7, 1.0}) {
    const Eigen::Vector3d p(place, 0.0, 0.0);
    MatrixXd s = MatrixXd::Zero(3, 2);
    s(0, 0) = place;              // depends on p₀: its part of φ is no new direction
    s(1, 1) = place * place * x;  // ∫ρ S² ~ x³
    body.mass += x;
    body.first_moment += x * p;
    body.second_moment += x * p * p.transpose();
    shape += x * s;
    for (int k = 0; k < 3; ++k) mixed.middleRows(3 * k, 3) += x * p(k) * s;
    for (std::size_t q = 0; q < 6; ++q) {
      const auto [k, l] = moment_pairs[q];
      moments[q] += x * s.row(k).transpose() * s.row(l);
    }
  }
  body.shape = sparse(shape);
  body.mixed = sparse(mixed);
  for (std::size_t q = 0; q < 6; ++q) body.moments[q] = sparse(moments[q]);
  body.mass_matrix = sparse(moments[0] + moments[1] + moments[2]);
  return body;
}

InvariantsFile particles_with_slopes(double x) {
  constexpr double h = 1e-6;
  InvariantsFile file = body_of(x);
  file.constants = particles(x);
  BodyConstants slope = zero_constants(file.constants);
  add_constants(slope, 0.5 / h, particles(x + h));
  add_constants(slope, -0.5 / h, particles(x - h));
  file.design[0].derivative = slope;
  return file;
}

/// Mass and stiffness for any step; slopes by differences of 1e-6: 1e-9.
TEST(ContinuedBody, StaysABodyForAnyStep) {
  const auto made = [](double x) {
    return std::make_shared<const InvariantsFile>(particles_with_slopes(x));
  };
  const auto source = continue_body("", {made(1.0), made(1.1)});
  for (const double x : {0.2, 0.5, 3.0}) {
    const BodyConstants body = source->at(values(x))->constants;
    const MatrixXd k(body.stiffness), m(body.mass_matrix);
    EXPECT_GT(k(0, 0), 0.0) << x;
    EXPECT_GT(k(0, 0) * k(1, 1) - k(0, 1) * k(1, 0), 0.0) << x;
    EXPECT_GT(m(0, 0), 0.0) << x;
    EXPECT_GT(m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0), 0.0) << x;
    EXPECT_GT(body.mass, 0.0);
  }
  const BodyConstants beside = source->at(values(1.001))->constants;
  EXPECT_LT(difference(beside.mass_matrix, particles(1.001).mass_matrix), 1e-6);
  EXPECT_LT(difference(beside.mixed, particles(1.001).mixed), 1e-6);
  EXPECT_NEAR(beside.mass, particles(1.001).mass, 1e-6);
}

/// The other order and other signs of the same coordinates.
InvariantsFile turned(const InvariantsFile& file) {
  const SparseMatrix t = sparse((MatrixXd(2, 2) << 0.0, -1.0, 1.0, 0.0).finished());
  InvariantsFile other = file;
  other.constants = in_coordinates(file.constants, t);
  return other;
}

TEST(AlignedBody, HasOrderAndSignsOfItsReference) {
  const InvariantsFile reference = body_of(1.0), other = turned(body_of(1.01));
  const SparseMatrix t = alignment_of(reference, other);
  const BodyConstants aligned = in_coordinates(other.constants, t);
  EXPECT_LT(difference(aligned.stiffness, body_of(1.01).constants.stiffness), 1e-15);
  EXPECT_LT(difference(aligned.shape, body_of(1.01).constants.shape), 1e-15);
}

TEST(AlignedBody, NeedsTheSameCoordinates) {
  const InvariantsFile reference = body_of(1.0);
  InvariantsFile other = body_of(1.0);
  other.coordinates.push_back("mode 3");
  EXPECT_THAT([&] { alignment_of(reference, other); },
              testing::ThrowsMessage<SimulationError>(HasSubstr("3 coordinates")));
  InvariantsFile mixed = reference;
  const double c = std::sqrt(0.5);
  mixed.constants.shape.setZero();
  mixed.constants.mixed.setZero();
  mixed.constants.places[0].displacement.setZero();
  mixed.constants.places[0].rotation = sparse((MatrixXd(3, 2) << 0, 0, 0, 0, c, c).finished());
  EXPECT_THAT([&] { alignment_of(reference, mixed); },
              testing::ThrowsMessage<SimulationError>(HasSubstr("stretching")));
}

/// A program that writes what stands in a file, and counts its calls.
class CountedProgram {
 public:
  CountedProgram() {
    std::ofstream(folder_.path() / "make.sh")
        << "echo call >>calls\n"
           "h=$(sed 's/.*\"height\":\\([^}]*\\)}.*/\\1/')\ncat \"body-$h.json\"\n";
  }

  void add(const std::string& height, const InvariantsFile& file) const {
    std::ofstream(folder_.path() / ("body-" + height + ".json")) << write_invariants(file);
  }

  /// @param derivatives  whether they are given
  BodyGenerator generator(bool derivatives) const {
    BodyGenerator generator;
    generator.body = "bar";
    generator.command = {"sh", "make.sh"};
    generator.folder = folder_.path().string();
    generator.variables = {{"height", "m"}};
    generator.gives_derivatives = derivatives;
    generator.step = 0.25;
    generator.time_limit = 20.0;
    generator.record = (folder_.path() / "record").string();
    return generator;
  }

  int calls() const {
    std::ifstream stream(folder_.path() / "calls");
    return static_cast<int>(std::count(std::istreambuf_iterator<char>(stream), {}, '\n'));
  }

 private:
  TemporaryFolder folder_;
};

TEST(BodyGenerator, IsCalledOnceForADesignWhoeverAsks) {
  const ProgramPermission permission;
  const CountedProgram counted;
  counted.add("0.5", body_of(0.5));
  for (int run = 0; run < 2; ++run) {
    const auto source = make_body_source(counted.generator(true));
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(source->at(values(0.5))->constants.mass, body_of(0.5).constants.mass);
    }
  }
  EXPECT_EQ(counted.calls(), 1);
}

/// A step of a quarter: (0.625³ − 0.5³)/0.125 and the like; with modes that came in another order.
TEST(BodyGenerator, DifferencesAreThoseOfItsCalls) {
  const ProgramPermission permission;
  const CountedProgram counted;
  counted.add("0.5", body_of(0.5));
  counted.add("0.625", turned(body_of(0.625)));
  const auto file = make_body_source(counted.generator(false))->at(values(0.5));
  BodyConstants expected = zero_constants(file->constants);
  add_constants(expected, 8.0, body_of(0.625).constants);
  add_constants(expected, -8.0, body_of(0.5).constants);
  EXPECT_LT(difference(file->design[0].derivative->stiffness, expected.stiffness), 1e-12);
  EXPECT_EQ(counted.calls(), 2);
}

TEST(BodyGenerator, FailsWithItsNameAndDesign) {
  const ProgramPermission permission;
  const CountedProgram counted;
  counted.add("1.0", body_of(0.5));
  const auto source = make_body_source(counted.generator(true));
  EXPECT_THAT([&] { source->at(values(0.75)); },
              testing::ThrowsMessage<SimulationError>(
                  AllOf(HasSubstr("height = 0.75 m"), HasSubstr("sh make.sh"))));
  EXPECT_THAT([&] { source->at(values(1.0)); },
              testing::ThrowsMessage<SimulationError>(HasSubstr("wrote a body of height = 0.5")));
}

}  // namespace
}  // namespace pleuel::test::made_body_test
