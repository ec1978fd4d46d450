#include <fmt/format.h>

#include "tests/cli/readback.hpp"

/// Error bars, read back.
namespace pleuel::test::readback_errors_test {
namespace {

using nlohmann::json;

/// A cell of the column of errors against its document.
void expect_bar(const std::string& shown, const std::string& unit, const json& error) {
  if (error.is_null()) {
    EXPECT_EQ(shown, "–");
  } else if (error.at("total").is_null()) {
    EXPECT_EQ(shown, "not resolved");
  } else if (error.at("total") == 0.0) {
    EXPECT_EQ(shown, "exact");
  } else {
    const std::string sign = "± ";
    ASSERT_TRUE(shown.starts_with(sign)) << shown;
    expect_shown(shown.substr(sign.size()), unit, error.at("total"));
  }
}

/// What the step leaves in a value is what an eighth of it changes; bars have some reserve.
TEST(ReadBackErrors, OfSimulateAreThoseOfTheirResponse) {
  const Report report = run({"simulate", file});
  const json responses = report.document.at("responses");
  const TemporaryFolder folder;
  const json finer =
      run_program(folder.path(), joined(joined({"simulate", file, "--json"}, quick()),
                                        {"--set", "/simulation/step=0.025 ms", "--set",
                                         "/simulation/resolution_check=false"}))
          .document()
          .at("responses");
  const TextTable table(report.text, "response");
  int bars = 0;
  for (const auto& [name, response] : responses.items()) {
    const std::size_t row = table.row_of(name);
    const json& error = response.at("error");
    expect_bar(table.text(row, "error"), table.text(row, "unit"), error);
    if (std::abs(error.value("order", 0.0) - 2.0) > 0.5) continue;
    ++bars;
    const double change =
        std::abs(finer.at(name).at("value").get<double>() - response.at("value").get<double>());
    EXPECT_GE(error.at("step"), change) << name;
    EXPECT_LE(error.at("step"), 4.0 * change) << name;
    EXPECT_NEAR(error.at("total"),
                error.at("step").get<double>() + error.at("elements").get<double>(),
                1e-9 * error.at("total").get<double>())
        << name;
  }
  EXPECT_GE(bars, 5);
  EXPECT_EQ(table.text(table.row_of("crank_and_rod"), "error"), "exact");
}

/// The mass is known exactly: its least value is as uncertain as the limits that decide, by their
/// multipliers. The sum is judged as one value: not by the sum of the bars, but by bars of its own.
TEST(ReadBackErrors, OfAnOptimumAreAboutThoseOfItsLimitsTimesTheirPrices) {
  const Report report = run({"optimize", file, "--verbose"});
  const json& objective = report.document.at("objective");
  double sum = 0.0;
  const std::map<std::string, std::string> responses = {{"crank_strength", "crank_stress"},
                                                        {"rod_strength", "rod_stress"},
                                                        {"rod_stiffness", "rod_bow"},
                                                        {"crank_stiffness", "crank_tip"}};
  for (const auto& [name, constraint] : report.document.at("constraints").items()) {
    const json& error = report.document.at("responses").at(responses.at(name)).at("error");
    const double multiplier = constraint.at("multiplier");
    if (multiplier != 0.0) sum += multiplier * error.at("total").get<double>();
  }
  ASSERT_GT(sum, 0.0);
  const double value = objective.at("value"), total = objective.at("error").at("total");
  EXPECT_GT(total, sum / 4.0);
  EXPECT_LT(total, 4.0 * sum);
  const std::string text = unwrapped(report.text);
  const auto behind = [&](const std::string& words) {
    const std::size_t at = text.find(words);
    EXPECT_NE(at, std::string::npos) << words << " in\n" << text;
    return at == std::string::npos ? "nan" : text.substr(at + words.size(), 24);
  };
  expect_shown(behind("known to ± "), "kg", total);
  const std::string known = behind("known to ± ");
  expect_shown(known.substr(known.find('(') + 1), "1", 100.0 * total / value);
  expect_shown(behind("steps and elements: to ± "), "1", 100.0 * total / value);
}

}  // namespace
}  // namespace pleuel::test::readback_errors_test
