#include <chrono>
#include <cstdlib>
#include <fstream>

#include "core/base/error.hpp"
#include "core/jobs/child_program.hpp"
#include "reduction/calculix_input.hpp"
#include "reduction/solid_matrices.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::calculix_test {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

TEST(CalculixInput, ReadsIncludedFilesSetsAndMaterials) {
  const TemporaryFolder folder;
  write(folder.path() / "mesh.inp",
        "*Node\n 7, 0, 0, 0\n 9, 1., 0, 0\n 3, 0, 1e0, 0\n4,0,0,+1\n 100, 5, 5, 5\n"
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
}  // namespace pleuel::test::calculix_test
