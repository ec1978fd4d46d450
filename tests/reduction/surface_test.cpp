#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <Eigen/Geometry>

#include "core/base/error.hpp"
#include "core/jobs/child_program.hpp"
#include "reduction/calculix_input.hpp"
#include "reduction/element_shape.hpp"
#include "reduction/reduce.hpp"
#include "reduction/solid_matrices.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::surface_test {
namespace {

// The surface of a block, whose area, volume and stretching are known.

ReducedBody with_surface(const Block& block, int points) {
  const TemporaryFolder folder;
  const auto path = write_block_model(folder.path(), block, make_block(block), "rigid",
                                      fmt::format(", \"modes\": 0, \"surface\": {}", points));
  return reduce(read_reduction_model(path.string()));
}

struct Enclosed {
  double area = 0.0, volume = 0.0;
};

/// By triangles that are anticlockwise seen from outside.
Enclosed enclosed_by(const BodySurface& surface) {
  Enclosed sum;
  for (const auto& [a, b, c] : surface.triangles) {
    const Eigen::Vector3d p = surface.positions.col(a), q = surface.positions.col(b),
                          r = surface.positions.col(c);
    sum.area += 0.5 * (q - p).cross(r - p).norm();
    sum.volume += p.dot(q.cross(r)) / 6.0;
  }
  return sum;
}

TEST(Surface, EnclosesTheBlock) {
  const Block block;
  const BodySurface surface = *with_surface(block, 100000).file.surface;
  const Enclosed found = enclosed_by(surface);
  const double around = 2.0 * (block.height + block.width) * block.length;
  EXPECT_NEAR(found.area / (around + 2.0 * block.area()), 1.0, 1e-9);
  EXPECT_NEAR(found.volume / (block.area() * block.length), 1.0, 1e-9);
  EXPECT_EQ(surface.young, block.young);
}

/// Fewer points keep the flat sides, and lose edges: by less than a cell of the grid.
TEST(Surface, OfFewerPointsIsNearly) {
  const Block block{0.4, 0.04, 0.03, 16, 4, 4};
  const BodySurface all = *with_surface(block, 100000).file.surface;
  const int most = static_cast<int>(all.positions.cols()) / 2;
  const BodySurface few = *with_surface(block, most).file.surface;
  EXPECT_LE(few.positions.cols(), most);
  EXPECT_GT(few.positions.cols(), most / 3);
  EXPECT_NEAR(enclosed_by(few).volume / enclosed_by(all).volume, 1.0, 0.15);
}

/// Pulled by a force, a prism without lateral contraction stretches by F x/EA.
TEST(Surface, StretchesAsThePrism) {
  const Block block;
  const ReducedBody body = with_surface(block, 200);
  const BodySurface& surface = *body.file.surface;
  const Eigen::VectorXd q = solve_dense(Eigen::MatrixXd(body.file.constants.stiffness),
                                        Eigen::VectorXd(Eigen::VectorXd::Unit(6, 0)));
  const Eigen::VectorXd u = surface.displacement * q;
  for (Eigen::Index i = 0; i < surface.positions.cols(); ++i) {
    const double expected = surface.positions(0, i) / (block.young * block.area());
    EXPECT_NEAR(u(3 * i), expected, 1e-8 * block.length / (block.young * block.area()));
  }
}

/// Single precision of the file.
TEST(Surface, IsReadAsItIsWritten) {
  const InvariantsFile file = with_surface(Block(), 60).file;
  const BodySurface &expected = *file.surface,
                    found = *read_invariants_text(write_invariants(file), "block.json").surface;
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_LE((found.positions - expected.positions).cwiseAbs().maxCoeff(), 1e-6 * 0.4);
  EXPECT_LE((found.displacement - expected.displacement).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Surface, HasToBeWhole) {
  const InvariantsFile file = with_surface(Block(), 60).file;
  std::string text = write_invariants(file);
  const std::string word = "\"triangles\": [[";
  text.replace(text.find(word), word.size(), "\"triangles\": [[9");
  EXPECT_THAT(thrown<InputError>([&] { read_invariants_text(text, "block.json"); }),
              HasSubstr("/surface/triangles/0/0"))
      << "a triangle with an unknown corner";
}

constexpr std::array shapes = {SolidShape::tetrahedron4, SolidShape::tetrahedron10,
                               SolidShape::hexahedron8, SolidShape::hexahedron20};

/// Whether r^a s^b t^c is among the functions of an element: up to a degree, in which factors that are linear
/// do not count for hexahedra.
bool has_monomial(SolidShape shape, const Eigen::Array3i& powers) {
  if (shape == SolidShape::tetrahedron4) return powers.sum() <= 1;
  if (shape == SolidShape::tetrahedron10) return powers.sum() <= 2;
  if (shape == SolidShape::hexahedron8) return powers.maxCoeff() <= 1;
  return powers.maxCoeff() <= 2 && (powers == 2).count() <= 1;
}

double power_of(const Eigen::Vector3d& x, const Eigen::Array3i& powers) {
  return std::pow(x(0), powers(0)) * std::pow(x(1), powers(1)) * std::pow(x(2), powers(2));
}

TEST(ElementShape, DifferentiatesItsPolynomialsExactly) {
  const Eigen::Vector3d at(0.2, 0.3, 0.1);
  for (const SolidShape shape : shapes) {
    const Eigen::MatrixX3d d = shape_derivatives(shape, at);
    int count = 0;
    for (int i = 0; i < 27; ++i) {
      const Eigen::Array3i powers(i % 3, i / 3 % 3, i / 9);
      if (!has_monomial(shape, powers)) continue;
      ++count;
      Eigen::VectorXd values(node_count(shape));
      for (int n = 0; n < node_count(shape); ++n)
        values(n) = power_of(local_node(shape, n), powers);
      for (int k = 0; k < 3; ++k) {
        Eigen::Array3i lower = powers;
        lower(k) = std::max(0, powers(k) - 1);
        EXPECT_NEAR(d.col(k).dot(values), powers(k) * power_of(at, lower), 1e-14);
      }
    }
    EXPECT_EQ(count, node_count(shape));
  }
}

TEST(ElementShape, OfTwentyNodesIsThatOfMonomials) {
  const Eigen::Vector3d at(0.2, -0.7, 0.4);
  EXPECT_LT((shape_derivatives(SolidShape::hexahedron20, at) - monomial_derivatives(at)).norm(),
            1e-12);
}

/// ∫ r² s over the unit tetrahedron = 2! 1!/6! (Dirichlet), over the cube of r² s² = 8/9.
TEST(ElementShape, QuadratureIsExactForPolynomials) {
  double tetrahedron = 0.0, cube = 0.0, volume = 0.0;
  for (const auto& [x, w] : quadrature(SolidShape::tetrahedron10)) {
    tetrahedron += w * x(0) * x(0) * x(1);
    volume += w;
  }
  for (const auto& [x, w] : quadrature(SolidShape::hexahedron20)) {
    cube += w * x(0) * x(0) * x(1) * x(1);
  }
  EXPECT_NEAR(volume, 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(tetrahedron, 2.0 / 360.0 / 2.0, 1e-16);
  EXPECT_NEAR(cube, 8.0 / 9.0, 1e-14);
}

// Points of stress in groups that responses can name.

ReducedBody with_groups(const std::string& more) {
  const TemporaryFolder folder;
  const Block block;
  const auto path = write_block_model(folder.path(), block, make_block(block), "rigid",
                                      R"(, "modes": 0, "stress": {"nodes": {
                             "top": {"box": [[0.1, 0.02, -1], [0.3, 0.02, 1]]},
                             "middle": {"box": [[0.2, -1, -1], [0.2, 1, 1]]}},
                             "strength": 3e8, "endurance_limit": 1e8)" +
                                          more + "}");
  return reduce(read_reduction_model(path.string()));
}

/// The three corners on the top in the middle are in both: 5 × 3 and 3 × 3 nodes.
TEST(StressGroups, ShareTheirPoints) {
  const StressRecovery stress = *with_groups("").file.constants.stress;
  ASSERT_EQ(stress.groups.size(), 2U);
  EXPECT_EQ(stress.groups[0].name, "top");
  EXPECT_EQ(named_points(stress, "top").size(), 15U);
  EXPECT_EQ(named_points(stress, "middle").size(), 9U);
  EXPECT_EQ(stress.points.size(), 21U);
  EXPECT_EQ(stress.strengths.endurance_limit, 1e8);
}

TEST(StressGroups, KeepThePointsOfEachThatCanBeLargest) {
  const StressRecovery stress = *with_groups(", \"most\": 4").file.constants.stress;
  for (const char* name : {"top", "middle"}) {
    EXPECT_FALSE(named_points(stress, name).empty()) << name;
    EXPECT_LE(named_points(stress, name).size(), 4U) << name;
  }
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

TEST(CalculixInput, ReadsIncludedFilesSetsAndMaterials) {
  const TemporaryFolder folder;
  write(
      folder.path() / "mesh.inp",
      "*Node\n 7, 0, 0, 0\n 9, 1., 0, 0\n*NODE, NSET=Late\n 3, 0, 1e0, 0\n4,0,0,+1\n 100, 5, 5, 5\n"
      "*ELEMENT, type=C3D4, ELSET=All\n11, 7, 9, 3, 4\n*Element, type=CPS3\n12, 7, 9, 3\n"
      "*NSET, NSET=base\n7, 9,\n3\n*NSET,NSET=two,GENERATE\n3,4\n*NSET,NSET=both\nbase,two\n");
  write(folder.path() / "job.inp",
        "** a comment\n*INCLUDE, INPUT=mesh.inp\n*MATERIAL, NAME=Steel\n*ELASTIC\n2e5, 0.3\n"
        "*DENSITY\n7.85e-9\n*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n");
  const SolidMesh mesh = read_calculix_input(folder.path() / "job.inp");
  EXPECT_EQ(mesh.numbers, (std::vector<int>{3, 4, 7, 9}));
  ASSERT_EQ(mesh.elements.size(), 1u);
  EXPECT_EQ(mesh.elements[0].nodes, (std::vector<int>{2, 3, 0, 1}));
  EXPECT_EQ(mesh.elements[0].material, 0);
  EXPECT_EQ(mesh.materials[0].poisson, 0.3);
  EXPECT_EQ(mesh.node_sets.at("BOTH"), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.node_sets.at("LATE"), (std::vector<int>{0, 1}));
  EXPECT_NEAR(volume_of(mesh), 1.0 / 6.0, 1e-14);
  EXPECT_NEAR(mass_of(mesh), 7.85e-9 / 6.0, 1e-22);
  EXPECT_EQ(surface_corners(mesh).size(), 4u);
}

TEST(CalculixInput, ErrorsNameFileAndLine) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) -> std::string {
    write(folder.path() / "a.inp", text);
    return thrown<InputError>([&] { read_calculix_input(folder.path() / "a.inp"); });
  };
  EXPECT_THAT(message("*NODE\n1, 0, x, 0\n"), HasSubstr("a.inp:2: \"x\" must be a number"));
  EXPECT_THAT(message("*ELEMENT, TYPE=C3D6\n"), HasSubstr("C3D6"));
  EXPECT_THAT(message("*ELEMENT, TYPE=C3D4\n5, 1, 2\n*NODE\n"), HasSubstr("element 5"));
  EXPECT_THAT(message("*NODE\n1, 0, 0, 0\n"), HasSubstr("no solid elements"));
}

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

/// CalculiX against the finite elements of the tests: both integrate bricks of 20 nodes with 27 points. It writes
/// 14 digits.
TEST(CalculixProgram, WritesTheMatricesThatTheTestsAssemble) {
  if (!has_program("ccx"))
    GTEST_SKIP() << "CalculiX (Debian package calculix-ccx) is not installed";
  const TemporaryFolder folder;
  Block block{0.2, 0.04, 0.03, 4, 2, 2};
  block.poisson = 0.3;
  const BlockModel model = make_block(block);
  write(folder.path() / "job.inp",
        block_input(block, model) + "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n6\n*END STEP\n");
  const std::string command = "cd " + folder.path().string() + " && ccx job >log 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const SolidMesh mesh = read_calculix_input(folder.path() / "job.inp");
  const SolidMatrices matrices = read_calculix_matrices(folder.path() / "job", mesh);
  const auto difference = [](const SolidMatrix& a, const SolidMatrix& b) {
    const Eigen::MatrixXd x(a), y(b);
    return (x - y).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff();
  };
  EXPECT_LT(difference(matrices.stiffness, model.stiffness), 1e-10);
  EXPECT_LT(difference(matrices.mass, model.mass), 1e-10);
}

std::string shell(const std::string& script, double limit = 0.0) {
  return output_of({{"sh", "-c", script}, {}, limit}, "two\nlines\n");
}

std::string failure_of(const ChildProgram& program) {
  return thrown<SimulationError>([&] { output_of(program, ""); });
}

TEST(ChildProgram, GetsItsInputAndGivesItsOutput) {
  EXPECT_EQ(shell("cat; echo unheard >&2"), "two\nlines\n");
}

/// More than any pipe holds, both ways.
TEST(ChildProgram, MayWriteMoreThanAPipeHolds) {
  EXPECT_EQ(shell("head -c 3000000 /dev/zero").size(), 3000000u);
}

TEST(ChildProgram, FailsWithItsCodeAndItsLastWords) {
  EXPECT_THAT(failure_of({{"sh", "-c", "echo no mesh >&2; exit 3"}, {}, 0.0}),
              AllOf(HasSubstr("exit code 3"), HasSubstr("no mesh")));
  EXPECT_THAT(failure_of({{"pleuel-has-no-such-program"}, {}, 0.0}), HasSubstr("in PATH"));
  EXPECT_THAT(failure_of({{"sh", "-c", "kill -9 $$"}, {}, 0.0}), HasSubstr("signal 9"));
}

/// It ends with all that it started.
TEST(ChildProgram, IsEndedAtItsTimeLimit) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(failure_of({{"sh", "-c", "sleep 60 & wait"}, {}, 0.2}), HasSubstr("limit of 0.2 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace pleuel::test::surface_test
