#include "studies/number_prices.hpp"

#include <fstream>
#include <iterator>

#include "core/base/eager_matrices.hpp"
#include "optimization/design/design_solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/files.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::number_prices_test {
namespace {

/// A bar of width b under a force F at its end, at rest; its height h has to carry it: the mass is
/// ρ L b h with h = √(6 F L / (b σ)). So m = ρ L^(3/2) b^(1/2) F^(1/2) √6 σ^(−1/2).
constexpr const char* bar = R"({
  "scene": {
    "materials": {"steel": {"young": "210 GPa", "poisson": 0.3, "density": "7850 kg/m^3"}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": ["400 mm", 0, 0],
                       "material": "steel", "elements": 2,
                       "section": {"type": "rectangle", "width": "30 mm", "height": {"variable": "height"}}}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {"press": {"type": "force", "body": "bar", "at": [0.4, 0, 0],
                        "direction": [0, -1, 0], "value": "0.5 kN"}}},
  "simulation": {"end_time": "1 ms", "step": "0.5 ms", "initial_state": "quasi-static"},
  "variables": {"height": {"start": "30 mm", "lower": "1 mm", "upper": "60 mm"}},
  "responses": {"m": {"type": "mass"}, "s": {"type": "stress", "body": "bar", "over_time": "max"}},
  "objective": {"minimize": "m"},
  "constraints": {"strength": {"response": "s", "upper": "100 MPa"}}})";

const double height_of_bar = std::sqrt(6 * 500 * 0.4 / (0.03 * 1e8));

const NumberPrice* find(const PriceList& list, const std::string& name) {
  const auto found = std::ranges::find(list.prices, name, &NumberPrice::name);
  return found == list.prices.end() ? nullptr : &*found;
}

/// What a percent of a number costs, in percent of the optimum; 0 with a failure if it has no price.
double exponent(const PriceList& list, const std::string& name) {
  const NumberPrice* price = find(list, name);
  EXPECT_NE(price, nullptr) << name;
  return price ? price->per_percent() / (0.01 * list.objective) : 0.0;
}

using Overrides = std::vector<std::string>;

/// Prices of the bar with overrides, at a height.
PriceList prices_at(double height, const Overrides& overrides = {}) {
  return number_prices({bar, "bar.json", overrides}, problem_from(bar, overrides),
                       Eigen::VectorXd::Constant(1, height));
}

std::vector<std::string> names_of(const std::vector<NumberGroup>& groups) {
  std::vector<std::string> names;
  for (const NumberGroup& group : groups) names.push_back(group.name);
  return names;
}

/// The numbers of the bar with overrides.
std::vector<std::string> priced_names(const Overrides& overrides = {}) {
  return names_of(
      priced_numbers({bar, "bar.json", overrides}, problem_from(bar, overrides)).groups);
}

TEST(NumberPrices, AreTheExponentsOfAClosedForm) {
  const PriceList list = prices_at(height_of_bar);
  EXPECT_NEAR(list.objective, 7850 * 0.4 * 0.03 * height_of_bar, 1e-12);
  EXPECT_LT(list.residual, 1e-6);
  for (const auto& [name, expected] :
       std::vector<std::pair<std::string, double>>{{"/scene/materials/steel/density", 1.0},
                                                   {"/scene/bodies/bar/to/0", 1.5},
                                                   {"/scene/bodies/bar/section/width", 0.5},
                                                   {"/scene/loads/press/value", 0.5},
                                                   {"/constraints/strength/upper", -0.5}}) {
    EXPECT_NEAR(exponent(list, name), expected, 1e-6) << name;
    EXPECT_EQ(find(list, name)->next_limit, "") << name;
  }
  // Stiffness moves the tip, not the mass: what is left is round-off, and no price.
  EXPECT_EQ(find(list, "/scene/materials/steel/young")->per_unit, 0.0);
  EXPECT_EQ(list.prices.front().name, "/scene/bodies/bar/to/0");
}

TEST(NumberPrices, OfABoundIsThatOfTheObjective) {
  const PriceList list =
      prices_at(0.04, {"/variables/height/start=50 mm", "/variables/height/lower=40 mm"});
  const NumberPrice* bound = find(list, "/variables/height/lower");
  ASSERT_NE(bound, nullptr);
  EXPECT_NEAR(bound->per_unit, 7850 * 0.4 * 0.03, 1e-6);
  // The mass goes with the height: a percent of 40 mm is a percent of it.
  EXPECT_EQ(bound->value, 0.04);
  EXPECT_NEAR(bound->per_percent(), 0.01 * list.objective, 1e-9);
  EXPECT_EQ(find(list, "/constraints/strength/upper"), nullptr);
  EXPECT_EQ(find(list, "/scene/loads/press/value")->per_unit, 0.0);
}

/// The optimum is at 20 mm, the bound at 20.05 mm: one percent more force would lift it by 0.5 %,
/// to where the upper bound decides.
TEST(NumberPrices, SaysWhichBoundDecidesNext) {
  const PriceList list = prices_at(
      height_of_bar, {"/variables/height/start=20 mm", "/variables/height/upper=20.05 mm"});
  EXPECT_EQ(find(list, "/scene/loads/press/value")->next_limit, "height");
  EXPECT_EQ(find(list, "/scene/materials/steel/density")->next_limit, "");
}

TEST(NumberPrices, OfAFixedVariableIsThatOfTheNumber) {
  const Overrides overrides = {
      R"(/scene/bodies/bar/section/width={"variable": "width"})",
      R"(/variables/width={"start": "30 mm", "lower": "30 mm", "upper": "30 mm"})"};
  const PriceList list = number_prices({bar, "bar.json", overrides}, problem_from(bar, overrides),
                                       Eigen::Vector2d(height_of_bar, 0.03));
  EXPECT_NEAR(exponent(list, "width"), 0.5, 1e-6);
  EXPECT_EQ(find(list, "width")->kind, NumberPrice::Kind::variable);
}

/// f = m/(1 kg) + s/(100 MPa) with m = ρ b L h and s = 6 F L/(b h²) is least at h³ = 12 F L/(ρ b² L
/// · 1e8), where s = m/2: a percent more density costs a percent of m. No limit holds this optimum.
TEST(NumberPrices, AreThoseOfAnOptimumThatNoLimitHolds) {
  const double height = std::cbrt(12.0 * 500.0 / (7850.0 * 0.03 * 0.03 * 1e8));
  const PriceList list = prices_at(
      height,
      {"/constraints={}", R"json(/objective={"minimize": "= m/(1 kg) + s/(100 MPa)"})json"});
  const double mass = 7850 * 0.4 * 0.03 * height;
  EXPECT_LT(list.residual, 1e-6);
  EXPECT_NEAR(list.objective, 1.5 * mass, 1e-6);
  EXPECT_NEAR(exponent(list, "/scene/materials/steel/density") * 0.01 * list.objective, 0.01 * mass,
              1e-6 * mass);
}

/// With its height from a list the bar stays as it is where a little more is allowed: only what
/// makes it heavier has a price.
TEST(NumberPrices, OfChosenSizesAreThoseWithThem) {
  const PriceList list = prices_at(
      0.02, {R"(/variables/height={"start": "20 mm", "choices": ["15 mm", "20 mm", "25 mm"]})"});
  EXPECT_LT(list.residual, 1e-6);
  EXPECT_NEAR(list.objective, 7850 * 0.4 * 0.03 * 0.02, 1e-12);
  EXPECT_NEAR(exponent(list, "/scene/materials/steel/density"), 1.0, 1e-10);
  EXPECT_EQ(exponent(list, "/scene/loads/press/value"), 0.0);
  EXPECT_EQ(find(list, "/constraints/strength/upper"), nullptr);
  EXPECT_EQ(find(list, "height"), nullptr);
}

/// A force of 40 Hz on the bar, whose motion repeats itself after 25 ms: its frequency sets the
/// period, its amplitude does not. The bar is as high as it may be, where stress counts more than mass.
TEST(NumberPrices, OfAMotionThatRepeatsItselfAreWithoutItsPeriod) {
  const Overrides overrides = {
      R"(/simulation={"end_time": "25 ms", "step": "0.5 ms", "initial_state": "periodic"})",
      R"(/scene/bodies/bar/damping={"stiffness": "0.1 ms"})",
      R"(/scene/loads/press/value={"type": "harmonic", "amplitude": "0.5 kN", "frequency": "40 Hz"})",
      "/variables/height/upper=20 mm",
      "/variables/height/start=20 mm",
      "/constraints={}",
      R"json(/objective={"minimize": "= m/(1 kg) + s/(100 MPa)"})json"};
  const PriceList list = prices_at(0.02, overrides);
  EXPECT_LT(list.residual, 1e-6);
  EXPECT_THAT(list.unknown, testing::Contains("/scene/loads/press/value/frequency"));
  EXPECT_EQ(find(list, "/scene/loads/press/value/frequency"), nullptr);
  const NumberPrice* amplitude = find(list, "/scene/loads/press/value/amplitude");
  ASSERT_NE(amplitude, nullptr);
  // Linear: the stress goes with the force.
  EXPECT_NEAR(amplitude->per_percent(), 0.01 * (list.objective - 7850 * 0.4 * 0.03 * 0.02),
              1e-4 * list.objective);
}

TEST(PricedNumbers, MovePointsThatAreSharedAsOne) {
  const auto groups = priced_numbers({bar, "bar.json"}, problem_from(bar)).groups;
  for (const NumberGroup& group : groups) {
    if (group.name == "/scene/bodies/bar/to/0") {
      EXPECT_THAT(group.pointers, ElementsAre("/scene/bodies/bar/to/0", "/scene/loads/press/at/0"));
    } else if (group.name == "/scene/bodies/bar/from/1") {
      EXPECT_THAT(group.pointers,
                  ElementsAre("/scene/bodies/bar/from/1", "/scene/joints/wall/at/1"));
    }
  }
  // Across the plane nothing is priced.
  EXPECT_THAT(names_of(groups), Not(testing::Contains("/scene/bodies/bar/to/2")));
  EXPECT_THAT(names_of(groups), testing::Contains("/scene/bodies/bar/to/1"));
}

TEST(PricedNumbers, AreThoseOfLibraryMaterialsToo) {
  std::string text = bar;
  const std::string declared =
      R"("materials": {"steel": {"young": "210 GPa", "poisson": 0.3, "density": "7850 kg/m^3"}},)";
  text.erase(text.find(declared), declared.size());
  const auto groups = priced_numbers({text, "bar.json"}, problem_from(text)).groups;
  EXPECT_THAT(names_of(groups), testing::Contains("/scene/materials/steel/density"));
}

TEST(PricedNumbers, LeaveOutWhatNoVariableCanStandFor) {
  EXPECT_THAT(priced_names({"/scene/gravity=[0, -9.81, 0]"}),
              Not(testing::Contains(HasSubstr("gravity"))));
  // The end of the bar cannot be moved without the load, which a formula places.
  const auto names = priced_names({"/scene/loads/press/at/0== 0.4 m + 0*height"});
  EXPECT_THAT(names, Not(testing::Contains("/scene/bodies/bar/to/0")));
  EXPECT_THAT(names, testing::Contains("/scene/bodies/bar/from/0"));
}

/// A load F at a place of a bar bends what carries it, M = F a with the height h = √(6 F a/(b σ)): the
/// mass goes with √a. What is at the end of the beam stays there.
TEST(NumberPrices, AreThoseOfPlacesOnElasticBeams) {
  const PriceList list =
      prices_at(std::sqrt(6 * 500 * 0.3 / (0.03 * 1e8)), {"/scene/loads/press/at/0=0.3"});
  EXPECT_NEAR(exponent(list, "/scene/loads/press/at/0"), 0.5, 1e-6);
  EXPECT_NEAR(exponent(list, "/scene/bodies/bar/to/0"), 1.0, 1e-6);
}

/// Binding a number to a variable that is fixed at its value changes no response.
TEST(PricedNumbers, LeaveTheMechanismAsItIsWhenTheyAreBound) {
  const std::string path = source_folder() + "/problems/slider_crank.json";
  const ProblemFile problem = read_problem(path).complete();
  std::ifstream stream(path);
  const ProblemText text{{std::istreambuf_iterator<char>(stream), {}}, path};
  const ProblemFile bound = bind_numbers(text, priced_numbers(text, problem).groups);
  ASSERT_GT(bound.variables.size(), problem.variables.size() + 10);
  const auto before = analyze(problem, start_design(problem));
  const auto after = analyze(bound, start_design(bound));
  EXPECT_EQ(before->model.mechanism.system->coordinates(),
            after->model.mechanism.system->coordinates());
  EXPECT_LT((values_of(*before) - values_of(*after))
                .cwiseQuotient(values_of(*before))
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
}

/// Re-optimized with a little more and less of each number: the optimum of the flexible
/// slider-crank, two limits and two proportions decide it.
TEST(NumberPrices, AreThoseOfOptimizingAnew) {
  const std::string path = source_folder() + "/problems/slider_crank.json";
  std::ifstream stream(path);
  const std::string file{std::istreambuf_iterator<char>(stream), {}};
  const std::string coarse = "/simulation/step=0.2 ms";
  const auto optimum = [&](const std::vector<std::string>& overrides) {
    DesignProblem design(read_problem(path, overrides).complete());
    return solve_design(design, {});
  };
  const Result result = verified(optimum({coarse}));
  const PriceList list =
      number_prices({file, path, {coarse}}, read_problem(path, {coarse}).complete(), result.x);
  struct Case {
    const char *pointer, *less, *more;
    double percents;  ///< between them
  };
  for (const Case& one :
       {Case{"/scene/materials/steel/density", "7810.75 kg/m^3", "7889.25 kg/m^3", 1.0},
        Case{"/scene/materials/steel/young", "208.95 GPa", "211.05 GPa", 1.0},
        Case{"/scene/joints/bearing/drive/speed", "199.95 rad/s", "200.05 rad/s", 0.05},
        Case{"/constraints/crank_strength/upper", "199 MPa", "201 MPa", 1.0}}) {
    const auto at = [&](const char* value) {
      return optimum({coarse, std::string(one.pointer) + "=" + value}).evaluation.objective;
    };
    const double anew = at(one.more) - at(one.less);
    const NumberPrice* price = find(list, one.pointer);
    ASSERT_NE(price, nullptr) << one.pointer;
    EXPECT_NEAR(one.percents * price->per_percent() / anew, 1.0, 0.01) << one.pointer;
  }
}

}  // namespace
}  // namespace pleuel::test::number_prices_test
