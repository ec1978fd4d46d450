/// Bodies from files, at other designs than the file's.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/trust/not_modelled.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::extrapolation_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A rigid-looking body whose file knows its mass at h = 30 mm and how it changes; only the finding's
/// own decision is looked at.
TEST(Extrapolation, IsADoubtWhereTheDesignHasLeftThatOfTheFile) {
  ProblemFile problem = read_scene(crank_rocker(driven, closed));
  const Eigen::VectorXd x0 = start_design(problem);
  const auto analysis = analyze(problem, x0);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  auto file = std::make_shared<InvariantsFile>();
  file->design.push_back({"h", 0.03, "m", file->constants});
  file->design.back().derivative->mass = 2.0;
  ImportedBody imported;
  imported.source = "rod.json";
  imported.file = file;
  imported.variables = {{Number::bound(0), quantities::length, 0}};
  problem.variables = {{"h", 0.03, 0.004, 0.06, "m"}};
  problem.scene.bodies.push_back({"imported", imported});
  const auto findings_at = [&](double height) {
    Eigen::VectorXd x(1);
    x << height;
    return check_extrapolation(TrustedRun{problem, x, *analysis, monitors});
  };
  EXPECT_THAT(findings_at(0.02), IsEmpty()) << "not continued";
  std::get<ImportedBody>(problem.scene.bodies.back().shape).is_linear = true;
  EXPECT_THAT(findings_at(0.03), IsEmpty());
  EXPECT_THAT(findings_at(0.03 * (1 + 0.9e-4)), IsEmpty());
  EXPECT_THAT(findings_at(0.03 * (1 - 0.9e-4)), IsEmpty());
  EXPECT_THAT(findings_at(0.03 * (1 + 1.1e-4)), SizeIs(1));
  EXPECT_THAT(findings_at(0.03 * (1 - 1.1e-4)), SizeIs(1));
  EXPECT_THAT(findings_at(0.03 * (1 + 1e-9)), IsEmpty());
  ASSERT_THAT(findings_at(0.0303), SizeIs(1));
  EXPECT_TRUE(findings_at(0.0303)[0].is_serious);
  EXPECT_THAT(findings_at(0.0303)[0].text, HasSubstr("h = 0.0303 instead of 0.03 m"));
  EXPECT_THAT(findings_at(0.0303)[0].text, HasSubstr("rod.json"));
}

}  // namespace
}  // namespace pleuel::test::extrapolation_test
