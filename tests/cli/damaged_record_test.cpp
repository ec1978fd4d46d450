#include <fstream>
#include <random>

#include <gmock/gmock.h>

#include "record/run_database.hpp"
#include "tests/cli/compared_runs.hpp"
#include "tests/cli/program.hpp"

/// Records that are damaged, or of another build, give no other numbers.
namespace pleuel::test::damaged_record_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class DamagedRecord : public ComparedRuns {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_line(folder_.path(), words_ + "whole").exit_code, 0);
    fs::copy(folder_.path() / "whole", folder_.path() / "run", fs::copy_options::recursive);
  }

  ProgramRun resumed() const { return run_line(folder_.path(), words_ + "run --resume"); }
  fs::path file() const { return folder_.path() / "run/run.sqlite"; }

  const std::string words_ =
      "optimize " + problem("slider_crank_round") + quick_line() + " --no-report -o ";
};

/// With checksums that are right: the evaluations that the verdict rests on are made again.
TEST_F(DamagedRecord, OfOtherNumbersIsNotVerified) {
  std::vector<NumberedEvaluation> all;
  RunDatabase(file()).read_evaluations([&](const NumberedEvaluation& one) { all.push_back(one); });
  Database(file()).execute("DELETE FROM evaluations");
  {
    RunDatabase record(file());
    for (NumberedEvaluation& one : all) {
      one.stored.evaluation.objective *= 0.9;
      record.keep(one.key, one.stored);
    }
  }
  const ProgramRun run = resumed();
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, AllOf(HasSubstr("run/run.sqlite: row "),
                             HasSubstr("of the table evaluations is not what this program "
                                       "computes"),
                             HasSubstr("--overwrite begins anew")));
}

TEST_F(DamagedRecord, OfAnotherBuildIsRefused) {
  RunDatabase(file()).describe("program", R"("fnv1a64:0")");
  const ProgramRun run = resumed();
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, AllOf(HasSubstr("run holds a run with another build of Pleuel"),
                             HasSubstr("--overwrite begins anew")));
}

TEST_F(DamagedRecord, WithoutWhatIsSaidOfTheRunIsRefused) {
  Database(file()).execute("DELETE FROM run");
  const ProgramRun run = resumed();
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, HasSubstr("run/run.sqlite: the table run has no row command"));
}

TEST_F(DamagedRecord, WithChangedNumbersIsNotExported) {
  Database(file()).execute("UPDATE evaluations SET constraints = zeroblob(7) WHERE id = 2");
  const ProgramRun run = run_line(folder_.path(), "export run");
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, HasSubstr("run/run.sqlite: row 2 of the table evaluations"));
}

/// Bytes that flip, and ends that are lost.
TEST_F(DamagedRecord, IsRefusedOrEndsAsIfItWereWhole) {
  const std::string whole = read_file(file());
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 30; ++round) {
    std::string damaged = whole;
    const std::size_t place =
        std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    if (round % 5 == 0) {
      damaged.resize(place);
    } else {
      damaged[place] = static_cast<char>(damaged[place] ^ (1 << round % 8));
    }
    std::ofstream(file(), std::ios::binary) << damaged;
    const ProgramRun run = resumed();
    if (run.exit_code == 0) {
      EXPECT_EQ(result("run"), result("whole")) << place;
      continue;
    }
    ++refused;
    EXPECT_EQ(run.exit_code, 2) << place << run.err;
    EXPECT_THAT(run.err, HasSubstr("run/run.sqlite: ")) << place;
    fs::copy(folder_.path() / "whole", folder_.path() / "run",
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace pleuel::test::damaged_record_test
