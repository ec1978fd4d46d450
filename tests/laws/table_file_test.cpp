#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/model/scene_geometry.hpp"
#include "tests/laws/law_problems.hpp"

namespace pleuel::test::table_file_test {
namespace {

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
    return std::get<TableFunction>(std::get<PointForce>(problem.scene.loads[0].element).value);
  }

  std::string refusal(const std::string& text, const std::string& keys) const {
    try {
      push(text, keys);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

 private:
  static std::string unique_name() {
    return "table-file-" + std::to_string(std::random_device{}());
  }
  fs::path folder_;
};

constexpr const char* by_name = R"("columns": ["time", "force"])";

void expect_push(const TableFunction& push) {
  EXPECT_THAT(push.times, testing::ElementsAre(testing::DoubleEq(0.0), testing::DoubleEq(0.02),
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
              testing::HasSubstr("/value/units/0 must be the unit of the first line of push.csv, "
                                 "\"time [s]\""));
}

/// A comma for decimals between commas that separate, and names that stand above other columns, as
/// of an index without a name.
TEST_F(TableFile, MustHaveNoMoreValuesThanColumns) {
  const std::string head = "time [s],force [N]\n";
  EXPECT_THAT(refusal(head + "0,0,0,5\n1,0,50,5\n", by_name),
              testing::HasSubstr("line 2: it has 4 values, but the first line 2"));
  EXPECT_THAT(refusal(head + "1,0,0\n2,1,50\n", by_name), testing::HasSubstr("it has 3 values"));
  EXPECT_THAT(refusal("0,1\n1,2,3\n", R"("columns": [1, 2], "units": ["ms", "kN"])"),
              testing::HasSubstr("line 2: it has 3 values, but the first line 2"));
  expect_push(push("time [ms],force [kN],\n0,0,\n20,1.5,\n50,-0.02,,\n", by_name));
}

TEST_F(TableFile, KeepsWhatIsQuotedTogether) {
  const std::string head = "\"time [ms]\",\"force [kN]\"\n";
  expect_push(push(head + "\"0\",\"0\"\n\"20\",\"1.5\"\n\"50\",\"-0.02\"\n", by_name));
  EXPECT_THAT(refusal(head + "\"0,0\",\"0\"\n\"20,0\",\"1,5\"\n", by_name),
              testing::HasSubstr("line 2: \"0,0\" is no number (decimals have a point)"));
  EXPECT_THAT(refusal(head + "0,0\n20,\"1,200\"\n", by_name),
              testing::HasSubstr("line 3: \"1,200\" is no number"));
}

TEST_F(TableFile, HasNoTwoColumnsOfOneName) {
  EXPECT_THAT(refusal("time [s],force [N],force [N]\n0,1,2\n1,2,3\n", by_name),
              testing::HasSubstr("has two columns of that name"));
}

TEST_F(TableFile, IsAnsweredWithTheLineThatIsWrong) {
  const std::string head = "time [s],force [N]\n";
  const auto refused = [&](const std::string& rows) { return refusal(head + rows, by_name); };
  EXPECT_THAT(
      refused("0,1\n1,x\n"),
      testing::HasSubstr(
          "/scene/loads/push/value/file names the file push.csv, line 3: \"x\" is no number"));
  EXPECT_THAT(refused("0,1\n# so\n\n0.5\n"), testing::HasSubstr("line 5: there is no column 2"));
  EXPECT_THAT(refused("0,1\n1,2\n1,3\n"),
              testing::HasSubstr("line 4: the first column must ascend"));
  EXPECT_THAT(refused("0,1\n1,nan\n"), testing::HasSubstr("line 3: \"nan\" is no number"));
  EXPECT_THAT(refused("0,1\n1,inf\n"), testing::HasSubstr("line 3: \"inf\" is no number"));
  EXPECT_THAT(refused("0;1\n1;2,5\n"), testing::HasSubstr("line 3: \"2,5\" is no number"));
  EXPECT_THAT(refused("0,1\n"), testing::HasSubstr("must have two rows of numbers at least"));
}

TEST_F(TableFile, IsAnsweredWhatItsColumnsLack) {
  EXPECT_THAT(refusal("time [s],force [N]\n0,1\n1,2\n", R"("columns": ["time", "froce"])"),
              testing::HasSubstr(
                  "/value/columns/1 names the unknown column \"froce\"; did you mean \"force\"?"));
  EXPECT_THAT(refusal("time,force [N]\n0,1\n1,2\n", by_name),
              testing::HasSubstr("/value/columns/0 has no unit; write it in the first line of "
                                 "push.csv, as in \"time [s]\""));
  EXPECT_THAT(refusal("time [s],force [N m]\n0,1\n1,2\n", by_name),
              testing::HasSubstr("/value/columns/1 has the unit \"N m\", but must be a force [N]"));
  EXPECT_THAT(refusal("0,1\n1,2\n", by_name), testing::HasSubstr("has no line of names"));
  EXPECT_THAT(refusal("", by_name), testing::HasSubstr("which is empty"));
  EXPECT_THAT(refusal("0,1\n1,2\n", R"("columns": [1, 2], "times": [0, 1])"),
              testing::HasSubstr("has the unknown key \"times\""));
}

}  // namespace
}  // namespace pleuel::test::table_file_test
