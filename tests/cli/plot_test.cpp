#include <memory>

#include "cli/text/log_log_chart.hpp"
#include "tests/cli/page_text.hpp"
#include "tests/cli/program.hpp"

namespace pleuel::test::plot_test {
namespace {

// Histories of a run as SVG and in the terminal.

namespace fs = std::filesystem;

class Plot : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ProgramFolder>();
    folder_->run("simulate $crank $quick --no-report -o one");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static const ProgramFolder& folder() { return *folder_; }

  inline static std::unique_ptr<ProgramFolder> folder_;
};

double number_behind(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  if (at == std::string::npos) throw std::runtime_error("there is no " + words);
  return std::stod(text.substr(at + words.size()));
}

TEST_F(Plot, DrawsThePeakOfTheTrajectoryInTheUnitsOfEngineers) {
  EXPECT_THAT(folder().run("plot one rod_stress").out,
              HasSubstr("Drawn in one/plot-rod_stress.svg"));
  const double highest =
      std::ranges::max(numbers(folder().csv("one/trajectory.csv"), "rod_stress"));
  const std::string svg = folder().text("one/plot-rod_stress.svg");
  EXPECT_NEAR(number_behind(svg, "data-peak=\""), highest / 1e6, 1e-9 * highest / 1e6);
  EXPECT_THAT(svg, HasSubstr("rod_stress [MPa]"));
  EXPECT_THAT(svg, HasSubstr("class=\"band\"")) << "the error band of the trajectory";
  const std::string card = folder().text("one/run_card.json");
  EXPECT_THAT(folder().refusal("plot one rod_stress -o one/run_card.json"),
              HasSubstr("is there already"));
  EXPECT_EQ(folder().text("one/run_card.json"), card);
}

/// What the last bits of a number say is no change: ticks that far apart would be without end.
TEST_F(Plot, DrawsWhatChangesByRoundOffOnlyAsAConstant) {
  fs::copy(folder() / "one", folder() / "constant", fs::copy_options::recursive);
  CsvRows rows = folder().csv("one/trajectory.csv");
  const auto column = std::ranges::find(rows[0], "rod_stress") - rows[0].begin();
  std::string text = fmt::format("{}\n", fmt::join(rows[0], ","));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    rows[i][column] = i % 2 == 0 ? "300000" : "300000.00000000006";
    text += fmt::format("{}\n", fmt::join(rows[i], ","));
  }
  folder().write("constant/trajectory.csv", text);
  folder().run("plot constant rod_stress");
  const std::string svg = folder().text("constant/plot-rod_stress.svg");
  EXPECT_NEAR(number_behind(svg, "data-peak=\""), 0.3, 1e-9);
  std::size_t ticks = 0, at = 0;
  while ((at = svg.find("class=\"grid\"", at) + 1) != 0) ++ticks;
  EXPECT_GE(ticks, 2u);
  EXPECT_LE(ticks, 10u);
}

TEST_F(Plot, ShowsTheCurveInTheTerminal) {
  // U+2800 … U+28FF are letters of dots.
  EXPECT_THAT(
      folder().run("plot one rod_stress crank_tip").out,
      AllOf(HasSubstr("rod_stress [MPa]"), HasSubstr("crank_tip [mm]"), HasSubstr("\xE2\xA1")));
  EXPECT_TRUE(folder().has("one/plot.svg"));
}

TEST_F(Plot, ListsWhatThereIsIfNothingIsAskedFor) {
  const std::string out = unwrapped(folder().run("plot one").out);
  EXPECT_THAT(out, AllOf(HasSubstr("Histories in one: crank_stress, rod_stress"),
                         Not(HasSubstr(":error"))));
}

TEST_F(Plot, SaysWhyItCannotDraw) {
  EXPECT_THAT(folder().refusal("plot one rod_stres"),
              HasSubstr("no history is called \"rod_stres\"; did you mean \"rod_stress\"?"));
  fs::create_directory(folder() / "torn");
  const std::string whole = folder().text("one/trajectory.csv");
  folder().write("torn/trajectory.csv", whole.substr(0, whole.size() / 2 + 3));
  EXPECT_THAT(folder().refusal("plot torn rod_stress"),
              HasSubstr("torn/trajectory.csv: is damaged: line "));
  fs::create_directory(folder() / "empty");
  EXPECT_THAT(folder().refusal("plot empty rod_stress"), HasSubstr("empty: has no histories"));
}

// Diagrams: well-formed, and what stands in them stands where the data say.

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

void expect_mark(const std::vector<ReadPoint>& marks, double x, double y, const json& of) {
  EXPECT_TRUE(std::ranges::any_of(marks, [&](const ReadPoint& mark) {
    return std::abs(std::log(mark.x / x)) < 0.03 && std::abs(std::log(mark.y / y)) < 0.03;
  })) << of;
}

/// The runs, then the knobs: as in the document of the result.
void expect_runs(const std::string& svg, const json& document, const char* errors,
                 const char* seconds) {
  const std::vector<ReadPoint> marks = read_points(svg);
  std::size_t found = 0;
  for (const char* kind : {"runs", "knobs"}) {
    for (const json& run : document.at(kind)) {
      if (run.contains("failure")) continue;
      expect_mark(marks, 100.0 * counted(document, run.at(errors)), 1e3 * number(run, seconds),
                  run);
      ++found;
    }
  }
  EXPECT_EQ(marks.size(), found);
}

/// In the charts and, for the optima, in what `optimize` finds with their overrides.
TEST(AccuracyCharts, ShowWhatTheResultSays) {
  const ProgramFolder folder;
  const json document = folder.document(
      "accuracy $crank $quick -o a --optimum "
      R"(--set '/accuracy={"steps": [4e-4, 2e-4], "elements": [2, 4]}')");
  expect_runs(folder.text("a/accuracy.svg"), document, "errors", "simulation_seconds");
  expect_runs(folder.text("a/accuracy-gradients.svg"), document, "gradient_errors", "seconds");
  const std::vector<ReadPoint> marks = read_points(folder.text("a/accuracy-optimum.svg"));
  const json& optima = document.at("optimum");
  ASSERT_EQ(marks.size(), optima.size());
  const double best = number(document, "optimum_reference/objective");
  const double floor = number(document, "optimum_reference/error");
  for (const json& one : optima) {
    const double error = number(one, "error");
    EXPECT_NEAR(error, number(one, "objective") - best, 1e-15);
    expect_mark(marks, 100.0 * std::max(std::abs(error), floor) / best, number(one, "seconds"),
                one);
  }
  const json found = folder.document("optimize $crank $quick -o o" + overrides_of(optima.front()));
  EXPECT_NEAR(number(found, "objective/value") / number(optima.front(), "objective"), 1.0, 1e-12);
  for (const auto& [name, value] : optima.front().at("variables").items()) {
    EXPECT_NEAR(number(found, "variables/" + name + "/value") / value.get<double>(), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace pleuel::test::plot_test
