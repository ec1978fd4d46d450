#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

namespace pleuel::test::gradient_test {
namespace {

TEST(Gradient, MethodsStandSideBySideAndAgree) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), joined({"gradient", problem("slider_crank_round"), "--method", "direct",
                             "--method", "central-difference", "--step", "1e-5", "--json"},
                            quick()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json document = run.document();
  const auto& mass = document.at("responses").at("crank_and_rod");
  EXPECT_EQ(mass.at("unit"), "kg");
  const auto& gradients = mass.at("gradients");
  for (const char* variable : {"crank_diameter", "rod_diameter"}) {
    const double direct = gradients.at("direct").at(variable);
    const double difference = gradients.at("central-difference").at(variable);
    EXPECT_NEAR(difference / direct, 1.0, 1e-9) << variable;  // a square: only round-off is left
  }
  EXPECT_TRUE(document.at("seconds").contains("simulate"));
  EXPECT_TRUE(document.at("seconds").contains("direct"));
}

TEST(Gradient, OfTheMassIsThatOfTwoCylinders) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), joined({"gradient", problem("slider_crank_round"), "--json"}, quick()));
  const auto gradients =
      run.document().at("responses").at("crank_and_rod").at("gradients").at("direct");
  // m = ρ L π d² / 4, so dm/dd = ρ L π d / 2 with ρ = 7850, d = 0.03, L = 0.12 and 0.18.
  EXPECT_NEAR(gradients.at("crank_diameter"), 7850 * 0.12 * M_PI * 0.03 / 2, 1e-10);
  EXPECT_NEAR(gradients.at("rod_diameter"), 7850 * 0.18 * M_PI * 0.03 / 2, 1e-10);
}

TEST(Gradient, WritesTheDerivativesOfHistories) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(),
      joined({"gradient", problem("slider_crank_round"), "--histories", "-o", "run"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = read_csv(folder.path() / "run" / "gradients.csv");
  const auto column = [&](const std::string& title) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    EXPECT_NE(found, rows[0].end()) << title;
    return static_cast<std::size_t>(found - rows[0].begin());
  };
  EXPECT_EQ(column("time"), 0u);
  EXPECT_EQ(rows.size(), read_csv(folder.path() / "run" / "trajectory.csv").size());
  // The slider's last position, which is that of the end.
  const nlohmann::json result =
      nlohmann::json::parse(read_file(folder.path() / "run" / "result.json"));
  const auto& end = result.at("responses").at("slider_end");
  EXPECT_EQ(std::stod(rows.back()[column("slider_end")]), end.at("value"));
  const double expected = end.at("gradients").at("direct").at("rod_diameter");
  EXPECT_NEAR(std::stod(rows.back()[column("slider_end:rod_diameter")]) / expected, 1.0, 1e-9);
}

TEST(Gradient, TakesTheMethodOfTheFile) {
  const TemporaryFolder folder;
  const std::vector<std::string> adjoint =
      joined({"gradient", problem("slider_crank_round"), "--json", "--set",
              R"(/sensitivity={"method": "adjoint"})"},
             quick());
  const auto methods = [&](const std::vector<std::string>& words) {
    std::vector<std::string> names;
    const nlohmann::json document = run_program(folder.path(), words).document();
    for (const auto& [name, gradient] :
         document.at("responses").at("rod_bow").at("gradients").items()) {
      names.push_back(name);
    }
    return names;
  };
  EXPECT_THAT(methods(adjoint), ::testing::ElementsAre("adjoint"));
  EXPECT_THAT(methods(joined(adjoint, {"--method", "forward-difference"})),
              ::testing::ElementsAre("forward-difference"));
}

TEST(Backends, AreListed) {
  const TemporaryFolder folder;
  const auto backends =
      run_program(folder.path(), {"backends", "--json"}).document().at("backends");
  EXPECT_THAT(backends.get<std::vector<std::string>>(), ::testing::Contains("ipopt"));
}

}  // namespace
}  // namespace pleuel::test::gradient_test
