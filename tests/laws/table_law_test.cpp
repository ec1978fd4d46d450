#include <filesystem>
#include <fstream>
#include <random>

#include "core/base/error.hpp"
#include "core/base/time_law.hpp"
#include "core/model/scene_geometry.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::table_law_test {
namespace {

using Values = std::vector<double>;

struct Shape {
  std::string name;
  TimeLaw<double> (*make)(Values, Values);
  TimeLaw<Dual> (*make_dual)(Values, std::vector<Dual>);
  int continuous_derivatives;
  bool is_monotone;
};

template <class Scalar>
TimeLaw<Scalar> straight(Values knots, std::vector<Scalar> values) {
  return {TimeLaw<Scalar>::Kind::linear, std::move(values), std::move(knots)};
}
template <class Scalar>
TimeLaw<Scalar> resting_cubic(Values knots, std::vector<Scalar> values) {
  return monotone_cubic(std::move(knots), std::move(values));
}
template <class Scalar>
TimeLaw<Scalar> motion_quintic(Values knots, std::vector<Scalar> values) {
  return monotone_quintic(std::move(knots), std::move(values));
}
template <class Scalar>
TimeLaw<Scalar> natural(Values knots, std::vector<Scalar> values) {
  return cubic_spline(std::move(knots), std::move(values), TableEnds::free);
}
template <class Scalar>
TimeLaw<Scalar> clamped(Values knots, std::vector<Scalar> values) {
  return cubic_spline(std::move(knots), std::move(values), TableEnds::resting);
}

const std::vector<Shape> shapes = {
    {"Linear", straight<double>, straight<Dual>, 0, true},
    {"MonotoneCubic", resting_cubic<double>, resting_cubic<Dual>, 1, true},
    {"MonotoneQuintic", motion_quintic<double>, motion_quintic<Dual>, 2, true},
    {"NaturalSpline", natural<double>, natural<Dual>, 2, false},
    {"ClampedSpline", clamped<double>, clamped<Dual>, 2, false}};

struct Table {
  Values times, values;
};

/// A press, a step, a motion from rest to rest, and noise at unequal distances.
std::vector<Table> tables() {
  std::vector<Table> all = {{{0, 0.25, 0.3, 0.35, 0.6}, {0, 0, 2e4, 0, 0}},
                            {{0, 0.1, 0.101, 0.3}, {0, 0, 200, 200}},
                            {{0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, {0, 4, 20, 45, 70, 86, 90}},
                            {{-1.0, 2.0}, {3.0, -1.0}}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    Table table;
    double time = 0.0;
    for (int k = 0; k < 9; ++k) {
      table.times.push_back(time += 0.01 + uniform(random));
      table.values.push_back(2.0 * uniform(random) - 1.0);
    }
    if (i % 2 == 0) std::sort(table.values.begin(), table.values.end());
    all.push_back(table);
  }
  return all;
}

class TableShape : public testing::TestWithParam<Shape> {};

TEST_P(TableShape, GoesThroughItsPointsAndHoldsTheValuesAtItsEnds) {
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    const double size =
        1e-14 *
        std::max(1.0, std::abs(*std::max_element(table.values.begin(), table.values.end())));
    for (std::size_t i = 0; i < table.times.size(); ++i) {
      EXPECT_NEAR(law.at(table.times[i]).value, table.values[i], size);
    }
    for (const auto& [time, value] : {std::pair{table.times.front() - 0.1, table.values.front()},
                                      {table.times.back() + 0.1, table.values.back()}}) {
      EXPECT_EQ(law.at(time).value, value);
      EXPECT_EQ(law.at(time).rate, 0.0);
      EXPECT_EQ(law.at(time).acceleration, 0.0);
    }
  }
}

TEST_P(TableShape, HasTheDerivativesOfItsValue) {
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
      const double width = table.times[i + 1] - table.times[i];
      const double rise = std::abs(table.values[i + 1] - table.values[i]) + 1e-3;
      for (const double share : {0.2, 0.57, 0.9}) {
        const double time = table.times[i] + share * width;
        const auto value = [&](double s) { return law.at(time + s * width).value; };
        const auto rate = [&](double s) { return law.at(time + s * width).rate; };
        const double scale = rise + std::abs(law.at(time).rate) * width;
        EXPECT_NEAR(law.at(time).rate * width, derivative_at_zero(value, 0.05), 1e-2 * scale);
        EXPECT_NEAR(law.at(time).rate * width, derivative_at_zero(value, 0.005), 1e-7 * scale);
        EXPECT_NEAR(law.at(time).acceleration * width, derivative_at_zero(rate, 0.005),
                    1e-6 * (scale / width + std::abs(law.at(time).acceleration * width)));
      }
    }
  }
}

/// Differences across a knot at 1e-7 of the intervals: what is continuous differs by as much.
TEST_P(TableShape, IsAsSmoothAsItSays) {
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    for (std::size_t i = 1; i + 1 < table.times.size(); ++i) {
      const double width =
          std::min(table.times[i] - table.times[i - 1], table.times[i + 1] - table.times[i]);
      const double size =
          std::abs(table.values[i + 1]) + std::abs(table.values[i]) + std::abs(table.values[i - 1]);
      const TimeValue<double> before = law.at(table.times[i] - 1e-7 * width),
                              after = law.at(table.times[i] + 1e-7 * width);
      EXPECT_NEAR(before.value, after.value, 1e-5 * size);
      if (GetParam().continuous_derivatives < 1) continue;
      EXPECT_NEAR(before.rate * width, after.rate * width, 1e-4 * size);
      if (GetParam().continuous_derivatives < 2) continue;
      EXPECT_NEAR(before.acceleration * width * width, after.acceleration * width * width,
                  1e-3 * size);
    }
  }
}

TEST_P(TableShape, StaysBetweenNeighbouringValuesWhereItIsMonotone) {
  double beyond = 0.0;
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
      const auto [low, high] = std::minmax(table.values[i], table.values[i + 1]);
      double previous = law.at(table.times[i]).value;
      for (int k = 1; k < 200; ++k) {
        const double share = k / 200.0;
        const double value =
            law.at(table.times[i] + share * (table.times[i + 1] - table.times[i])).value;
        beyond = std::max({beyond, (low - value) / (std::abs(low) + std::abs(high) + 1.0),
                           (value - high) / (std::abs(low) + std::abs(high) + 1.0)});
        if (GetParam().is_monotone) {
          const double way = table.values[i + 1] >= table.values[i] ? 1.0 : -1.0;
          EXPECT_GE(way * (value - previous), -1e-12 * (std::abs(low) + std::abs(high)));
        }
        previous = value;
      }
    }
  }
  if (GetParam().is_monotone) {
    EXPECT_LE(beyond, 1e-13);
  } else {
    EXPECT_GE(beyond, 0.1);
  }
}

/// In all values, at places in all intervals; away from the kinks where chords change their sign.
TEST_P(TableShape, IsDifferentiatedByItsValues) {
  const Values times = {0.0, 0.1, 0.25, 0.3, 0.6}, values = {0.5, 1.0, 3.0, 2.0, -1.0};
  for (std::size_t j = 0; j < values.size(); ++j) {
    std::vector<Dual> seeded(values.begin(), values.end());
    seeded[j] = Dual(values[j], Dual::Derivatives::Constant(1.0));
    const TimeLaw<Dual> law = GetParam().make_dual(times, seeded);
    for (const double time : {0.03, 0.11, 0.27, 0.5}) {
      const auto of = [&](auto member) {
        return [&, member](double s) {
          Values moved = values;
          moved[j] += s;
          return GetParam().make(times, moved).at(time).*member;
        };
      };
      const TimeValue<Dual> found = law.at(time);
      EXPECT_NEAR(derivative_of(found.value),
                  derivative_at_zero(of(&TimeValue<double>::value), 1e-3), 1e-9);
      EXPECT_NEAR(derivative_of(found.rate), derivative_at_zero(of(&TimeValue<double>::rate), 1e-3),
                  1e-7);
      EXPECT_NEAR(derivative_of(found.acceleration),
                  derivative_at_zero(of(&TimeValue<double>::acceleration), 1e-3), 1e-5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, TableShape, testing::ValuesIn(shapes),
                         [](const auto& test) { return test.param.name; });

/// y = t²(3 − 2t) has no rate at 0 and at 1; y = 1 + 2t no second derivative anywhere.
TEST(Spline, IsExactForTheCubicThatItsEndsAllow) {
  const Values times = {0.0, 0.2, 0.7, 1.0};
  Values bent, line;
  for (const double t : times) {
    bent.push_back(t * t * (3 - 2 * t));
    line.push_back(1 + 2 * t);
  }
  const TimeLaw<double> from_rest = clamped<double>(times, bent),
                        straight_on = natural(times, line);
  for (const double t : {0.1, 0.4, 0.55, 0.9}) {
    EXPECT_NEAR(from_rest.at(t).value, t * t * (3 - 2 * t), 1e-14);
    EXPECT_NEAR(from_rest.at(t).acceleration, 6 - 12 * t, 1e-12);
    EXPECT_NEAR(straight_on.at(t).value, 1 + 2 * t, 1e-14);
  }
}

TEST(MotionTable, StartsAndEndsAtRest) {
  const Values times = {0.0, 0.1, 0.2}, values = {0.0, 1.0, 3.0};
  for (const auto make : {motion_quintic<double>, clamped<double>}) {
    const TimeLaw<double> law = make(times, values);
    EXPECT_EQ(law.at(0.0).rate, 0.0);
    EXPECT_NEAR(law.at(0.2 * (1 - 1e-12)).rate, 0.0, 1e-8);
  }
}

TEST(StepTable, HoldsEachValueAndTakesTheMeanAtAJumpAndTheNewValueAtTheStart) {
  const TimeLaw<double> law{TimeLaw<double>::Kind::step, {1.0, 4.0, 2.0}, {-1.0, 0.0, 0.5}};
  EXPECT_EQ(law.at(-2.0).value, 1.0);
  EXPECT_EQ(law.at(-0.1).value, 1.0);
  EXPECT_EQ(law.at(-1e-300).value, 1.0);
  EXPECT_EQ(law.at(0.0).value, 4.0);
  EXPECT_EQ(law.at(0.2).value, 4.0);
  EXPECT_EQ(law.at(0.5).value, 3.0);
  EXPECT_EQ(law.at(0.6).value, 2.0);
  EXPECT_EQ(law.at(0.6).rate, 0.0);
}

namespace fs = std::filesystem;

/// A folder of its own, with a file and a problem that takes its push from it.
class TableFile : public testing::Test {
 protected:
  TableFile() : folder_(fs::temp_directory_path() / unique_name()) {
    fs::create_directories(folder_);
  }
  ~TableFile() override { fs::remove_all(folder_); }

  /// The push that the file gives, with these keys beside its name.
  TableFunction push(const std::string& text, const std::string& keys) const {
    std::ofstream(folder_ / "push.csv") << text;
    std::ofstream(folder_ / "block.json") << R"({"scene": {
    "bodies": {"block": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"slide": {"type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0], "axis": [1, 0, 0]}},
    "loads": {"push": {"type": "force", "body": "block", "at": [0, 0, 0], "direction": [1, 0, 0],
      "value": {"type": "table", "file": "push.csv", )" +
                                                 keys + R"(}}}},
  "simulation": {"end_time": 0.1, "step": 1e-3}})";
    const ProblemFile problem = read_problem((folder_ / "block.json").string()).complete();
    return std::get<TableFunction>(std::get<PointLoad>(problem.scene.loads[0].element).value);
  }

  std::string refusal(const std::string& text, const std::string& keys) const {
    return thrown<InputError>([&] { push(text, keys); });
  }

 private:
  static std::string unique_name() {
    return "table-file-" + std::to_string(std::random_device{}());
  }
  fs::path folder_;
};

constexpr const char* by_name = R"("columns": ["time", "force"])";

void expect_push(const TableFunction& push) {
  EXPECT_THAT(push.times, ElementsAre(testing::DoubleEq(0.0), testing::DoubleEq(0.02),
                                      testing::DoubleEq(0.05)));
  ASSERT_EQ(push.values.size(), 3U);
  EXPECT_DOUBLE_EQ(push.values[1].constant, 1500.0);
  EXPECT_DOUBLE_EQ(push.values[2].constant, -20.0);
}

TEST_F(TableFile, HasColumnsByNameWithTheUnitsOfItsFirstLine) {
  expect_push(push("# measured\ntime [ms],angle [deg],force [kN]\n0,1,0\n20,2,1.5\n\n50,3,-2e-2\n",
                   by_name));
}

TEST_F(TableFile, MayHaveOtherSeparatorsAndLineEnds) {
  expect_push(
      push("\xEF\xBB\xBF\"force (kN)\";\"time (ms)\"\r\n0;0\r\n+1.5;20\r\n-0.02;50\r\n", by_name));
  expect_push(push("time [ms]\tforce [kN]\n0\t0\n20\t1.5\n50\t-0.02", by_name));
  expect_push(
      push("  0    0\n 20  1.5\n 50  -0.02\n", R"("columns": [1, 2], "units": ["ms", "kN"])"));
}

TEST_F(TableFile, MustNotContradictTheUnitsOfTheProblem) {
  const std::string rows = "0,0\n20,1.5\n50,-0.02\n";
  const std::string keys = R"("columns": ["time", "force"], "units": ["ms", "kN"])";
  expect_push(push("time [ms],force (kN)\n" + rows, keys));
  expect_push(push("time,force (measured)\n" + rows, keys));
  EXPECT_THAT(refusal("time [s],force [kN]\n" + rows, keys),
              HasSubstr("/value/units/0 must be the unit of the first line of push.csv, "
                        "\"time [s]\""));
}

/// A comma for decimals between commas that separate, and names that stand above other columns, as
/// of an index without a name.
TEST_F(TableFile, MustHaveNoMoreValuesThanColumns) {
  const std::string head = "time [s],force [N]\n";
  EXPECT_THAT(refusal(head + "0,0,0,5\n1,0,50,5\n", by_name),
              HasSubstr("line 2: it has 4 values, but the first line 2"));
  EXPECT_THAT(refusal(head + "1,0,0\n2,1,50\n", by_name), HasSubstr("it has 3 values"));
  EXPECT_THAT(refusal("0,1\n1,2,3\n", R"("columns": [1, 2], "units": ["ms", "kN"])"),
              HasSubstr("line 2: it has 3 values, but the first line 2"));
  expect_push(push("time [ms],force [kN],\n0,0,\n20,1.5,\n50,-0.02,,\n", by_name));
}

TEST_F(TableFile, KeepsWhatIsQuotedTogether) {
  const std::string head = "\"time [ms]\",\"force [kN]\"\n";
  expect_push(push(head + "\"0\",\"0\"\n\"20\",\"1.5\"\n\"50\",\"-0.02\"\n", by_name));
  EXPECT_THAT(refusal(head + "\"0,0\",\"0\"\n\"20,0\",\"1,5\"\n", by_name),
              HasSubstr("line 2: \"0,0\" is no number (decimals have a point)"));
  EXPECT_THAT(refusal(head + "0,0\n20,\"1,200\"\n", by_name),
              HasSubstr("line 3: \"1,200\" is no number"));
}

TEST_F(TableFile, HasNoTwoColumnsOfOneName) {
  EXPECT_THAT(refusal("time [s],force [N],force [N]\n0,1,2\n1,2,3\n", by_name),
              HasSubstr("has two columns of that name"));
}

TEST_F(TableFile, IsAnsweredWithTheLineThatIsWrong) {
  const std::string head = "time [s],force [N]\n";
  const auto refused = [&](const std::string& rows) { return refusal(head + rows, by_name); };
  EXPECT_THAT(
      refused("0,1\n1,x\n"),
      HasSubstr(
          "/scene/loads/push/value/file names the file push.csv, line 3: \"x\" is no number"));
  EXPECT_THAT(refused("0,1\n# so\n\n0.5\n"), HasSubstr("line 5: there is no column 2"));
  EXPECT_THAT(refused("0,1\n1,2\n1,3\n"), HasSubstr("line 4: the first column must ascend"));
  EXPECT_THAT(refused("0,1\n1,nan\n"), HasSubstr("line 3: \"nan\" is no number"));
  EXPECT_THAT(refused("0,1\n1,inf\n"), HasSubstr("line 3: \"inf\" is no number"));
  EXPECT_THAT(refused("0;1\n1;2,5\n"), HasSubstr("line 3: \"2,5\" is no number"));
  EXPECT_THAT(refused("0,1\n"), HasSubstr("must have two rows of numbers at least"));
}

TEST_F(TableFile, IsAnsweredWhatItsColumnsLack) {
  EXPECT_THAT(
      refusal("time [s],force [N]\n0,1\n1,2\n", R"("columns": ["time", "froce"])"),
      HasSubstr("/value/columns/1 names the unknown column \"froce\"; did you mean \"force\"?"));
  EXPECT_THAT(refusal("time,force [N]\n0,1\n1,2\n", by_name),
              HasSubstr("/value/columns/0 has no unit; write it in the first line of "
                        "push.csv, as in \"time [s]\""));
  EXPECT_THAT(refusal("time [s],force [N m]\n0,1\n1,2\n", by_name),
              HasSubstr("/value/columns/1 has the unit \"N m\", but must be a force [N]"));
  EXPECT_THAT(refusal("0,1\n1,2\n", by_name), HasSubstr("has no line of names"));
  EXPECT_THAT(refusal("", by_name), HasSubstr("which is empty"));
  EXPECT_THAT(refusal("0,1\n1,2\n", R"("columns": [1, 2], "times": [0, 1])"),
              HasSubstr("has the unknown key \"times\""));
}

}  // namespace
}  // namespace pleuel::test::table_law_test
