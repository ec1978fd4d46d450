#include <fstream>

#include "cli/text/log_log_chart.hpp"
#include "tests/cli/page_text.hpp"
#include "tests/cli/program.hpp"
#include "tests/cli/readback.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::plot_test {
namespace {

// Histories of a run as SVG and in the terminal.

namespace fs = std::filesystem;

class Plot : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    const ProgramRun run =
        exits(0, run_program(folder(), joined({"simulate", problem("slider_crank_round"),
                                               "--no-report", "-o", "one"},
                                              quick())));
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
  const ProgramRun run = exits(0, run_program(folder(), {"plot", "one", "rod_stress"}));
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
  const std::string card = read_file(folder() / "one/run_card.json");
  const ProgramRun refused =
      run_program(folder(), {"plot", "one", "rod_stress", "-o", "one/run_card.json"});
  EXPECT_THAT(exits(2, refused).err, HasSubstr("is there already"));
  EXPECT_EQ(read_file(folder() / "one/run_card.json"), card);
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
  const ProgramRun run = exits(0, run_program(folder(), {"plot", "constant", "rod_stress"}));
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
  const ProgramRun run = exits(0, run_program(folder(), {"plot", "one"}));
  EXPECT_THAT(unwrapped(run.out), HasSubstr("Histories in one: crank_stress, rod_stress"));
  EXPECT_THAT(run.out, Not(HasSubstr(":error")));
}

TEST_F(Plot, NamesWhatIsProbablyMeant) {
  EXPECT_THAT(exits(2, run_program(folder(), {"plot", "one", "rod_stres"})).err,
              HasSubstr("no history is called \"rod_stres\"; did you mean \"rod_stress\"?"));
}

TEST_F(Plot, SaysWhereAFileIsDamaged) {
  fs::create_directory(folder() / "torn");
  const std::string whole = read_file(folder() / "one/trajectory.csv");
  std::ofstream(folder() / "torn/trajectory.csv") << whole.substr(0, whole.size() / 2 + 3);
  const ProgramRun run = exits(2, run_program(folder(), {"plot", "torn", "rod_stress"}));
  EXPECT_THAT(run.err, HasSubstr("torn/trajectory.csv: is damaged: line "));
}

TEST_F(Plot, OfAFolderWithoutHistoriesSaysWhichCommandsWriteSome) {
  fs::create_directory(folder() / "empty");
  const ProgramRun run = exits(2, run_program(folder(), {"plot", "empty", "rod_stress"}));
  EXPECT_THAT(run.err, HasSubstr("empty: has no histories"));
}

// Diagrams: well-formed, and what stands in them stands where the data say.

using nlohmann::json;

LogLogChart chart_of(const std::vector<ChartPoint>& points) {
  LogLogChart chart;
  chart.title =
      R"(<a "strange" & long name> ÄÖÜ of a problem that goes on and on and on and on and on)";
  chart.x_label = "error [%]";
  chart.y_label = "time [ms]";
  chart.series = {{"one & <two>", points, true}};
  return chart;
}

/// 0.5 px of some 500 px for the decades of the data.
void expect_at(const ReadPoint& read, const ChartPoint& point) {
  EXPECT_NEAR(std::log10(read.x / point.x), 0.0, 0.02);
  EXPECT_NEAR(std::log10(read.y / point.y), 0.0, 0.02);
}

TEST(LogLogChart, PointsStandWhereTheDataSay) {
  // Twelve decades, one decade, and all the same.
  for (const auto& points : std::vector<std::vector<ChartPoint>>{
           {{1e-9, 1e3}, {1e3, 1e-9}, {0.02, 3.0}}, {{2.1, 31.0}, {4.7, 30.0}}, {{0.3, 0.3}}}) {
    const std::vector<ReadPoint> read = read_points(to_svg(chart_of(points)));
    ASSERT_EQ(read.size(), points.size());
    for (std::size_t i = 0; i < read.size(); ++i) expect_at(read[i], points[i]);
  }
}

TEST(LogLogChart, IsWellFormedWithoutAnyPoint) {
  EXPECT_EQ(read_points(to_svg(chart_of({}))).size(), 0u);
}

TEST(LogLogChart, JoinsThePointsThanWhichNoOtherIsBetterInBoth) {
  const std::string svg = to_svg(chart_of({{1, 10}, {2, 5}, {3, 6}, {4, 1}, {5, 9}, {1, 12}}));
  for (const XmlElement& element : read_xml(svg)) {
    if (element.name != "path" || !element.has_class("front")) continue;
    const std::string& path = element.attributes.at("d");
    EXPECT_EQ(std::count(path.begin(), path.end(), 'L'), 2);  // (1, 10) (2, 5) (4, 1)
    return;
  }
  FAIL() << "no front";
}

TEST(LogLogChart, FailuresAndExactOnesStandOnTheRims) {
  const std::string svg =
      to_svg(chart_of({{0.0, 3.0, "exact"}, {1.0, 2.0}, {0.0, 0.0, "why & how", "", true}}));
  const std::vector<XmlElement> elements = read_xml(svg);
  double left = 0.0, right = 0.0, failure = -1.0;
  std::vector<double> marks;
  for (const XmlElement& element : elements) {
    if (element.has_class("frame")) {
      left = element.number("x");
      right = left + element.number("width");
    }
    if (!element.has_class("point")) continue;
    const double x = std::stod(element.attributes.at("transform").substr(10));
    (element.has_class("failure") ? failure : marks.emplace_back()) = x;
  }
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_NEAR(marks[0], left, 0.01);
  EXPECT_GT(marks[1], left + 1.0);
  EXPECT_NEAR(failure, right, 0.01);
  EXPECT_THAT(svg, HasSubstr("why &amp; how"));
}

/// Boxes of texts by a generous estimate of their width.
TEST(LogLogChart, LabelsOverlapNeitherEachOtherNorMarks) {
  std::vector<ChartPoint> points;
  for (int i = 0; i < 40; ++i) {
    const double place = 0.5 * i;
    points.push_back({std::pow(10.0, std::sin(place)), std::pow(10.0, std::cos(1.7 * place)), "",
                      fmt::format("{} ms", i)});
  }
  struct Place {
    double x, y;
  };
  std::vector<Place> labels, marks;
  for (const XmlElement& element : read_xml(to_svg(chart_of(points)))) {
    if (element.name == "text" && element.text.ends_with(" ms")) {
      labels.push_back({element.number("x"), element.number("y") - 5.0});
    }
    if (element.has_class("point")) {
      const std::string& move = element.attributes.at("transform");
      marks.push_back({std::stod(move.substr(10)), std::stod(move.substr(move.find(' ')))});
    }
  }
  EXPECT_GT(labels.size(), 10u);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_TRUE(std::abs(labels[i].x - labels[j].x) > 30 ||
                  std::abs(labels[i].y - labels[j].y) > 11);
    }
    for (const Place& mark : marks) {
      EXPECT_TRUE(std::abs(labels[i].x - mark.x) > 15 || std::abs(labels[i].y - mark.y) > 5);
    }
  }
}

double counted(const json& document, const json& errors) {
  double largest = 0.0;
  for (const std::string name : document.at("counted")) {
    largest = std::max(largest, errors.at(name).get<double>());
  }
  return largest;
}

/// The runs, then the knobs: as in the document of the result.
void expect_runs(const std::string& svg, const json& document, const char* errors,
                 const char* seconds) {
  std::vector<ReadPoint> read = read_points(svg);
  std::size_t found = 0;
  for (const char* kind : {"runs", "knobs"}) {
    for (const json& run : document.at(kind)) {
      if (run.contains("failure")) continue;
      const double x = 100.0 * counted(document, run.at(errors));
      const double y = 1e3 * run.at(seconds).get<double>();
      const bool stands = std::any_of(read.begin(), read.end(), [&](const ReadPoint& point) {
        return std::abs(std::log(point.x / x)) < 0.03 && std::abs(std::log(point.y / y)) < 0.03;
      });
      EXPECT_TRUE(stands) << run;
      ++found;
    }
  }
  EXPECT_EQ(read.size(), found);
}

TEST(AccuracyCharts, ShowWhatTheResultSays) {
  const ProgramFolder folder;
  const json document =
      exits(0, folder.run_quick(
                   {"accuracy", problem("slider_crank_round"), "--json", "-o", "a", "--set",
                    R"(/accuracy={"steps": [4e-4, 2e-4], "elements": [2, 4]})", "--optimum"}))
          .document();
  const auto svg = [&](const char* name) { return read_file(folder.path() / "a" / name); };
  expect_runs(svg("accuracy.svg"), document, "errors", "simulation_seconds");
  expect_runs(svg("accuracy-gradients.svg"), document, "gradient_errors", "seconds");
  const std::vector<ReadPoint> optima = read_points(svg("accuracy-optimum.svg"));
  const json& runs = document.at("optimum");
  ASSERT_EQ(optima.size(), runs.size());
  const double best = document.at("optimum_reference").at("objective");
  const double floor = document.at("optimum_reference").at("error");
  for (const json& one : runs) {
    const double error = one.at("error");
    EXPECT_NEAR(error, one.at("objective").get<double>() - best, 1e-15);
    const double x = 100.0 * std::max(std::abs(error), floor) / best, y = one.at("seconds");
    EXPECT_TRUE(std::any_of(optima.begin(), optima.end(), [&](const ReadPoint& point) {
      return std::abs(std::log(point.x / x)) < 0.03 && std::abs(std::log(point.y / y)) < 0.03;
    })) << one;
  }
}

/// What `optimize` finds with the overrides is the optimum that stands there.
TEST(AccuracyCommand, OptimaAreThoseOfOptimizeWithTheirOverrides) {
  const ProgramFolder folder;
  const std::string file = problem("slider_crank_round");
  const ProgramRun run =
      exits(0, folder.run_quick({"accuracy", file, "--json", "-o", "a", "--optimum", "--set",
                                 R"(/accuracy={"steps": [4e-4, 2e-4], "elements": [2, 3]})"}));
  const json optimum = run.document().at("optimum").front();
  std::vector<std::string> words = joined({"optimize", file, "--json", "-o", "o"}, quick());
  for (const auto& [pointer, value] : optimum.at("overrides").items()) {
    words.insert(words.end(), {"--set", pointer + "=" + value.dump()});
  }
  const json found = folder.run(words).document();
  EXPECT_NEAR(
      found.at("objective").at("value").get<double>() / optimum.at("objective").get<double>(), 1.0,
      1e-12);
  for (const auto& [name, value] : optimum.at("variables").items()) {
    EXPECT_NEAR(found.at("variables").at(name).at("value").get<double>() / value.get<double>(), 1.0,
                1e-9);
  }
}

}  // namespace
}  // namespace pleuel::test::plot_test
