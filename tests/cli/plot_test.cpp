#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

/// Histories of a run as SVG and in the terminal.
namespace pleuel::test::plot_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class Plot : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    const ProgramRun run = run_program(
        folder(),
        joined({"simulate", problem("slider_crank_round"), "--no-report", "-o", "one"}, quick()));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path folder() { return folder_->path(); }

  static std::unique_ptr<TemporaryFolder> folder_;
};

std::unique_ptr<TemporaryFolder> Plot::folder_;

double number_behind(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  if (at == std::string::npos) throw std::runtime_error("there is no " + words);
  return std::stod(text.substr(at + words.size()));
}

TEST_F(Plot, DrawsThePeakOfTheTrajectoryInTheUnitsOfEngineers) {
  const ProgramRun run = run_program(folder(), {"plot", "one", "rod_stress"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Drawn in one/plot-rod_stress.svg"));
  const CsvRows rows = read_csv(folder() / "one/trajectory.csv");
  const auto column = static_cast<std::size_t>(
      std::find(rows[0].begin(), rows[0].end(), "rod_stress") - rows[0].begin());
  double highest = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    highest = std::max(highest, std::stod(rows[i][column]));
  }
  const std::string svg = read_file(folder() / "one/plot-rod_stress.svg");
  EXPECT_NEAR(number_behind(svg, "data-peak=\""), highest / 1e6, 1e-9 * highest / 1e6);
  EXPECT_THAT(svg, HasSubstr("rod_stress [MPa]"));
  EXPECT_THAT(svg, HasSubstr("class=\"band\"")) << "the error band of the trajectory";
}

/// What the last bits of a number say is no change: ticks that far apart would be without end.
TEST_F(Plot, DrawsWhatChangesByRoundOffOnlyAsAConstant) {
  const fs::path copy = folder() / "constant";
  fs::copy(folder() / "one", copy, fs::copy_options::recursive);
  const CsvRows rows = read_csv(copy / "trajectory.csv");
  const auto column = std::find(rows[0].begin(), rows[0].end(), "rod_stress") - rows[0].begin();
  std::ofstream file(copy / "trajectory.csv");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<std::string> row = rows[i];
    if (i > 0) row[column] = i % 2 == 0 ? "300000" : "300000.00000000006";
    file << fmt::format("{}\n", fmt::join(row, ","));
  }
  file.close();
  const ProgramRun run = run_program(folder(), {"plot", "constant", "rod_stress"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::string svg = read_file(copy / "plot-rod_stress.svg");
  EXPECT_NEAR(number_behind(svg, "data-peak=\""), 0.3, 1e-9);
  std::size_t ticks = 0, at = 0;
  while ((at = svg.find("class=\"grid\"", at) + 1) != 0) ++ticks;
  EXPECT_GE(ticks, 2u);
  EXPECT_LE(ticks, 10u);
}

TEST_F(Plot, ShowsTheCurveInTheTerminal) {
  const ProgramRun run = run_program(folder(), {"plot", "one", "rod_stress", "crank_tip"});
  EXPECT_THAT(run.out, HasSubstr("rod_stress [MPa]"));
  EXPECT_THAT(run.out, HasSubstr("crank_tip [mm]"));
  // Letters of U+2800 … U+28FF other than the empty one.
  EXPECT_NE(run.out.find("\xE2\xA1"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder() / "one/plot.svg"));
}

TEST_F(Plot, ListsWhatThereIsIfNothingIsAskedFor) {
  const ProgramRun run = run_program(folder(), {"plot", "one"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(unwrapped(run.out), HasSubstr("Histories in one: crank_stress, rod_stress"));
  EXPECT_THAT(run.out, Not(HasSubstr(":error")));
}

TEST_F(Plot, NamesWhatIsProbablyMeant) {
  const ProgramRun run = run_program(folder(), {"plot", "one", "rod_stres"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("no history is called \"rod_stres\"; did you mean \"rod_stress\"?"));
}

TEST_F(Plot, SaysWhereAFileIsDamaged) {
  fs::create_directory(folder() / "torn");
  const std::string whole = read_file(folder() / "one/trajectory.csv");
  std::ofstream(folder() / "torn/trajectory.csv") << whole.substr(0, whole.size() / 2 + 3);
  const ProgramRun run = run_program(folder(), {"plot", "torn", "rod_stress"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("torn/trajectory.csv: is damaged: line "));
}

TEST_F(Plot, OfAFolderWithoutHistoriesSaysWhichCommandsWriteSome) {
  fs::create_directory(folder() / "empty");
  const ProgramRun run = run_program(folder(), {"plot", "empty", "rod_stress"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("empty: has no histories"));
}

}  // namespace
}  // namespace pleuel::test::plot_test
