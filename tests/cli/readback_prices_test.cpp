#include <set>

#include "tests/cli/readback.hpp"

/// Prices, read back.
namespace pleuel::test::readback_prices_test {
namespace {

using nlohmann::json;

/// "bodies/crank/to/0 (+2)" is "/scene/bodies/crank/to/0" of the document.
const json& price_of(const json& prices, std::string name) {
  name = "/" + name.substr(0, name.find(" (+"));
  return prices.at(prices.contains(name) ? name : "/scene" + name);
}

void expect_signed(const std::string& shown, const std::string& unit, double si) {
  EXPECT_TRUE(shown.starts_with(si < 0.0 ? "−" : "+")) << shown;
  expect_shown(shown.starts_with("+") ? shown.substr(1) : shown, unit, si);
}

/// In units of the table: a price per millimetre is a thousandth of that per metre.
TEST(ReadBackPrices, AreThoseOfTheDocumentInUnitsOfTheUser) {
  const Report report = run({"prices", file});
  const TextTable table(report.text, "number");
  const json& prices = report.document.at("prices");
  const double mass = report.document.at("objective").at("value");
  std::set<std::string> units;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const json& price = price_of(prices, table.text(row, "number"));
    const std::string unit = table.text(row, "unit");
    const double value = price.at("value"), per_unit = price.at("per_unit");
    if (unit == "mm" || unit == "MPa" || unit == "ms" || unit == "rad/s" || unit == "kg") {
      units.insert(unit);
      if (value != 0.0) expect_shown(table.text(row, "value"), unit, value);
      expect_signed(table.text(row, "kg/unit"), unit == "rad/s" ? "kg" : "kg/" + unit, per_unit);
    }
    if (value == 0.0) continue;
    expect_signed(table.text(row, "kg at +1 %"), "kg", 0.01 * value * per_unit);
    expect_signed(table.text(row, "at +1 %"), "1", value * per_unit / mass);
  }
  EXPECT_GE(units.size(), 4u);
}

}  // namespace
}  // namespace pleuel::test::readback_prices_test
