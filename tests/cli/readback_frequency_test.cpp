#include <fstream>

#include <fmt/format.h>

#include "tests/cli/readback.hpp"

/// Frequencies, which documents have in radians a second and people read in hertz.
namespace pleuel::test::readback_frequency_test {
namespace {

using nlohmann::json;

/// A round cantilever of 0.8 m that is clamped; its mass against its lowest natural frequency.
const char* const cantilever = R"({"name": "cantilever", "scene": {
    "bodies": {"arm": {"type": "beam", "from": [0, 0, 0], "to": ["800 mm", 0, 0], "material": "steel",
                       "section": {"type": "circle", "diameter": {"variable": "d"}}, "elements": 6}},
    "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": "1 ms", "step": "1 ms"}, "effects": {"rotary_inertia": "off"},
  "variables": {"d": {"start": "40 mm", "lower": "10 mm", "upper": "60 mm"}},
  "responses": {"mass": {"type": "mass", "bodies": ["arm"]}, "pitch": {"type": "frequency"}},
  "objective": {"minimize": "mass"},
  "constraints": {"tuned": {"response": "pitch", "lower": "40 Hz"}},
  "pareto": {"constraint": "tuned", "from": "30 Hz", "to": "50 Hz", "points": 2},
  "uncertainty": {"parameters": {"d": {"deviation": "0.1 mm"}}}})";

/// Radians a second in documents, hertz in limits and tables: f = 3.516/(2π L²) (d/4) √(E/ρ).
class ReadBackFrequency : public testing::Test {
 protected:
  ReadBackFrequency() { std::ofstream(folder_.path() / "cantilever.json") << cantilever; }

  std::pair<std::string, json> run(const std::string& command,
                                   const std::vector<std::string>& more = {}) const {
    const ProgramRun run =
        run_program(folder_.path(), joined({command, "cantilever.json", "-o", command}, more));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return {run.out, json::parse(read_file(folder_.path() / command / "result.json"))};
  }
  static double hertz_of(double diameter) {
    return 3.516015268500151 / (2 * M_PI * 0.64) * diameter / 4 * std::sqrt(210e9 / 7850.0);
  }

  TemporaryFolder folder_;
};

TEST_F(ReadBackFrequency, IsShownInHertz) {
  const auto [text, document] = run("simulate");
  const TextTable table(text, "response"), limits(text, "constraint");
  const double expected = hertz_of(0.040);
  EXPECT_NEAR(document.at("responses").at("pitch").at("value"), 2 * M_PI * expected,
              1e-4 * 2 * M_PI * expected);
  EXPECT_EQ(table.text(table.row_of("pitch"), "unit"), "Hz");
  EXPECT_NEAR(table.number(table.row_of("pitch"), "value"), expected, 1e-3 * expected);
  EXPECT_NEAR(document.at("constraints").at("tuned").at("limit"), 2 * M_PI * 40, 1e-9);
  EXPECT_EQ(limits.text(0, "unit"), "Hz");
  EXPECT_THAT(limits.text(0, "limit"), testing::StartsWith("≥"));
  expect_shown(limits.text(0, "limit"), "Hz", 2 * M_PI * 40);
  expect_shown(limits.text(0, "value"), "Hz", document.at("responses").at("pitch").at("value"));
  // More than the limit asks for: 40 Hz of it are used.
  expect_shown(limits.text(0, "used"), "1", 100 * 40 / expected);
  EXPECT_THAT(text, testing::ContainsRegex("tuned .* kept\n"));
}

TEST_F(ReadBackFrequency, LimitsAnOptimumInHertz) {
  const auto [text, document] = run("optimize", {"--verbose"});
  const double diameter = 0.040 * 40 / hertz_of(0.040);
  EXPECT_NEAR(document.at("variables").at("d").at("value"), diameter, 1e-4 * diameter);
  const TextTable table(text, "constraint");
  expect_shown(table.text(0, "limit"), "Hz", 2 * M_PI * 40);
  expect_shown(table.text(0, "value"), "Hz", document.at("constraints").at("tuned").at("value"));
  // The mass goes with f²: m' = 2 m/f, in kg/(rad/s) and kg/Hz; one percent costs two.
  const double mass = 7850 * M_PI / 4 * diameter * diameter * 0.8;
  EXPECT_NEAR(document.at("objective").at("value"), mass, 2e-4 * mass);
  EXPECT_NEAR(document.at("constraints").at("tuned").at("multiplier"), -2 * mass / (2 * M_PI * 40),
              1e-3 * mass / (M_PI * 40));
  EXPECT_NEAR(table.number(0, "multiplier [kg/unit]"), -2 * mass / 40, 2e-3 * 2 * mass / 40);
  EXPECT_NEAR(table.number(0, "at +1 % limit"), 2.0, 0.011);
  EXPECT_THAT(table.text(0, "at +1 % limit"), testing::StartsWith("+"));
}

/// A margin of two deviations of 0.1 mm: d − 0.2 mm is in tune. Of an upper limit it has the other
/// sign: at most 40 Hz, from which the mass is kept by a limit of its own.
TEST_F(ReadBackFrequency, KeepsMarginsWithTheSignOfTheirSide) {
  const auto optimum = [&](const std::vector<std::string>& more) {
    const ProgramRun run =
        run_program(folder_.path(),
                    joined({"optimize", "cantilever.json", "-o", "margin", "--overwrite"}, more));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  };
  const double in_tune = 40.0 * 40 / hertz_of(0.040);  // [mm]
  const TextTable lower(optimum({"--set", "/constraints/tuned/deviations=2"}), "variable");
  EXPECT_NEAR(lower.number(0, "optimum"), in_tune + 0.2, 2e-3);
  const std::string text = optimum({"--set", "/constraints/tuned/deviations=2"});
  EXPECT_EQ(TextTable(text, "constraint").text(0, "constraint"), "tuned −2 σ");
  const std::string upper = optimum(
      {"--set", R"(/constraints={"slow": {"response": "pitch", "upper": "40 Hz", "deviations": 3},
                                 "heavy": {"response": "mass", "lower": "3 kg"}})",
       "--set", R"(/pareto={"constraint": "heavy", "from": "3 kg", "to": "4 kg"})"});
  const TextTable limits(upper, "constraint");
  EXPECT_EQ(limits.text(0, "constraint"), "slow +3 σ");
  EXPECT_EQ(limits.text(1, "constraint"), "heavy");
}

/// A limit is kept as exactly as a verified optimum keeps it: to 1e-4 of it.
TEST_F(ReadBackFrequency, SaysWhichLimitsAreBroken) {
  const double hertz =
      run("simulate").second.at("responses").at("pitch").at("value").get<double>() / (2 * M_PI);
  const auto is_kept = [&](const char* side, double limit) {
    const ProgramRun run = run_program(
        folder_.path(),
        {"simulate", "cantilever.json", "--json", "-o", "kept", "--overwrite", "--set",
         fmt::format(R"(/constraints/tuned={{"response": "pitch", "{}": "{:.12g} Hz"}})", side,
                     limit)});
    return run.document().at("constraints").at("tuned").at("kept").get<bool>();
  };
  EXPECT_TRUE(is_kept("lower", hertz * (1 + 0.9e-4)));
  EXPECT_FALSE(is_kept("lower", hertz * (1 + 1.1e-4)));
  EXPECT_TRUE(is_kept("upper", hertz * (1 - 0.9e-4)));
  EXPECT_FALSE(is_kept("upper", hertz * (1 - 1.1e-4)));
}

/// Of two limits the nearer one is shown: 45.2 Hz between 40 and 47, and between 44 and 60.
TEST_F(ReadBackFrequency, IsShownAgainstTheNearerOfTwoLimits) {
  const auto expect_limit = [&](double lower, double upper, bool is_upper) {
    const ProgramRun run = run_program(
        folder_.path(),
        {"simulate", "cantilever.json", "-o", "two", "--overwrite", "--set",
         fmt::format(
             R"(/constraints/tuned={{"response": "pitch", "lower": "{} Hz", "upper": "{} Hz"}})",
             lower, upper),
         "--set", R"(/constraints/heavy={"response": "mass", "lower": 1})", "--set",
         "/pareto/constraint=heavy", "--set", "/pareto/from=1 kg", "--set", "/pareto/to=2 kg"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json tuned =
        json::parse(read_file(folder_.path() / "two/result.json")).at("constraints").at("tuned");
    const double expected = 2 * M_PI * (is_upper ? upper : lower);
    EXPECT_EQ(tuned.at("side"), is_upper ? "upper" : "lower");
    EXPECT_NEAR(tuned.at("limit"), expected, 1e-9);
    const TextTable table(run.out, "constraint");
    const std::string shown = table.text(table.row_of("tuned"), "limit");
    EXPECT_TRUE(shown.starts_with(is_upper ? "≤" : "≥")) << shown;
    expect_shown(shown, "Hz", expected);
  };
  expect_limit(40, 47, true);
  expect_limit(44, 60, false);
}

/// Lower mass asks for 35.4 mm, less deflection for all that is allowed.
TEST_F(ReadBackFrequency, MarksVariablesAtTheirBounds) {
  const auto report = [&](const std::vector<std::string>& more) {
    return run_program(folder_.path(),
                       joined({"optimize", "cantilever.json", "-o", "bound", "--overwrite"}, more))
        .out;
  };
  using testing::ContainsRegex;
  EXPECT_THAT(report({}), ContainsRegex("\n  d .* mm *\n"));
  EXPECT_THAT(report({"--set", "/variables/d/lower=38 mm"}),
              ContainsRegex("\n  d .* mm +at its lower bound\n"));
  EXPECT_THAT(report({"--set", R"(/scene/loads={"f": {"type": "force", "body": "arm",
                                 "at": [0.8, 0, 0], "direction": [0, 1, 0], "value": 1}})",
                      "--set", "/simulation/initial_state=quasi-static", "--set",
                      R"(/responses/tip={"type": "deflection", "body": "arm", "at": 1,
                         "over_time": "max-abs"})",
                      "--set", "/objective/minimize=tip"}),
              ContainsRegex("\n  d .* mm +at its upper bound\n"));
  EXPECT_THAT(report({"--set", R"(/scene/materials/iron={"young": 2.1e11, "poisson": 0.3,
                                   "density": {"variable": "rho"}})",
                      "--set", "/scene/bodies/arm/material=iron", "--set",
                      R"(/variables/rho={"start": 7850, "lower": 7850, "upper": 7850})"}),
              ContainsRegex("\n  rho .* fixed\n"));
}

/// The history of a magnitude is one of magnitudes, of whatever sign the largest is: a press of
/// 1 kN has F/A = −0.796 MPa everywhere.
TEST_F(ReadBackFrequency, ComesWithHistoriesOfMagnitudes) {
  const ProgramRun run = run_program(
      folder_.path(),
      {"simulate", "cantilever.json", "-o", "press", "--set",
       R"(/scene/loads={"f": {"type": "force", "body": "arm", "at": [0.8, 0, 0],
                              "direction": [-1, 0, 0], "value": 1000}})",
       "--set", "/simulation/initial_state=quasi-static", "--set", "/scene/gravity=[0, 0, 0]",
       "--set", R"(/responses/largest={"type": "stress", "part": "axial", "body": "arm",
                                       "over_time": "max-abs"})",
       "--set", R"(/responses/highest={"type": "stress", "part": "axial", "body": "arm",
                                       "over_time": "max"})"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const CsvRows rows = read_csv(folder_.path() / "press/trajectory.csv");
  const double stress = 1000 / (M_PI / 4 * 0.04 * 0.04);
  for (std::size_t column = 0; column < rows[0].size(); ++column) {
    const double sign = rows[0][column] == "largest" ? 1.0 : -1.0;
    if (rows[0][column] != "largest" && rows[0][column] != "highest") continue;
    for (std::size_t row = 1; row < rows.size(); ++row) {
      EXPECT_NEAR(std::stod(rows[row].at(column)), sign * stress, 1e-3 * stress) << rows[0][column];
    }
  }
  EXPECT_EQ(rows[0].size(), 1 + 2 * 2u);  // with the bands of both
}

TEST_F(ReadBackFrequency, VariesAlongAFrontInHertz) {
  const auto [text, document] = run("pareto");
  const TextTable table(text, "limit [Hz]");
  ASSERT_EQ(table.rows(), 2u);
  const CsvRows rows = read_csv(folder_.path() / "pareto/pareto.csv");
  const auto limit_column = static_cast<std::size_t>(
      std::find(rows[0].begin(), rows[0].end(), "limit") - rows[0].begin());
  const double hertz[] = {30, 50};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(document.at("points").at(i).at("limit"), 2 * M_PI * hertz[i], 1e-9);
    EXPECT_NEAR(std::stod(rows.at(i + 1).at(limit_column)), 2 * M_PI * hertz[i], 1e-9);
    expect_shown(table.text(i, "limit [Hz]"), "Hz", 2 * M_PI * hertz[i]);
    EXPECT_NEAR(table.number(i, "pitch [Hz]"), hertz[i], 2e-4 * hertz[i]);
    EXPECT_NEAR(table.number(i, "d [mm]"), 40.0 * hertz[i] / hertz_of(0.040), 1e-2);
  }
}

TEST_F(ReadBackFrequency, ScattersInHertz) {
  const auto [text, document] = run("uncertainty");
  const TextTable table(text, "response");
  const std::size_t row = table.row_of("pitch");
  EXPECT_EQ(table.text(row, "unit"), "Hz");
  EXPECT_NEAR(document.at("responses").at("pitch").at("deviation"), 2 * M_PI * hertz_of(0.1e-3),
              1e-3 * 2 * M_PI * hertz_of(0.1e-3));
  EXPECT_NEAR(table.number(row, "deviation"), hertz_of(0.1e-3), 2e-3 * hertz_of(0.1e-3));
  EXPECT_NEAR(table.number(row, "bounds ±"), 3 * hertz_of(0.1e-3), 6e-3 * hertz_of(0.1e-3));
}

TEST_F(ReadBackFrequency, HasItsGradientInHertzAUnit) {
  const std::vector<std::string> words = {"gradient", "cantilever.json", "--method", "direct"};
  const std::string text = run_program(folder_.path(), words).out;
  const json document = run_program(folder_.path(), joined(words, {"--json"})).document();
  const TextTable table(text, "response");
  const std::size_t row = table.row_of("pitch");
  EXPECT_EQ(table.text(row, "unit"), "Hz/mm");
  const json& gradients = document.at("responses").at("pitch").at("gradients");
  const double expected = hertz_of(1.0);  // [Hz/m]
  for (const auto& [method, gradient] : gradients.items()) {
    EXPECT_NEAR(gradient.at("d"), 2 * M_PI * expected, 1e-3 * 2 * M_PI * expected) << method;
    EXPECT_NEAR(table.number(row, method), 1e-3 * expected, 1e-6 * expected) << method;
  }
}

}  // namespace
}  // namespace pleuel::test::readback_frequency_test
