#include "record/run_database.hpp"

#include <csignal>
#include <fstream>
#include <limits>
#include <random>

#include <sys/wait.h>
#include <unistd.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::run_database_test {
namespace {

class Record : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "run.sqlite"; }
  /// The file, opened anew.
  RunDatabase record() const { return RunDatabase(file()); }
  void execute(const std::string& statement) const { Database(file()).execute(statement); }

  /// What opens and reads it whole says of it; empty if all is well.
  std::string refusal() const {
    return thrown<DatabaseError>([&] { record().check(); });
  }

 private:
  TemporaryFolder folder_;
};

EvaluationKey key(double x, Request request = Request::values_and_gradients,
                  const std::string& method = "") {
  return {"step 1e-05 s", "constraints", method, request, Eigen::Vector2d(x, 1.0 / 3.0)};
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Of two variables and three constraints.
StoredEvaluation evaluated(double objective) {
  StoredEvaluation stored;
  stored.evaluation.objective = objective;
  stored.evaluation.constraints = Eigen::Vector3d(0.1, -0.0, 5e-324);
  stored.evaluation.objective_gradient = Eigen::Vector2d(1.0 / 7.0, 1e308);
  stored.evaluation.constraint_jacobian = Eigen::MatrixXd::Random(3, 2);
  stored.method = "adjoint";
  stored.reason = "fewer values than variables";
  stored.seconds = 0.25;
  return stored;
}

TEST_F(Record, GivesEvaluationsBackBitByBitWhenItIsOpenedAgain) {
  const StoredEvaluation stored = evaluated(0.1 + 0.2);
  RunDatabase(file()).keep(key(0.1), stored);
  RunDatabase again(file());
  const auto found = again.find(key(0.1));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->evaluation.objective, stored.evaluation.objective);
  EXPECT_EQ(found->evaluation.constraints, stored.evaluation.constraints);
  EXPECT_TRUE(std::signbit(found->evaluation.constraints(1)));
  EXPECT_EQ(found->evaluation.objective_gradient, stored.evaluation.objective_gradient);
  EXPECT_EQ(found->evaluation.constraint_jacobian, stored.evaluation.constraint_jacobian);
  EXPECT_EQ(found->reason, stored.reason);
  EXPECT_EQ(found->seconds, 0.25);
  EXPECT_EQ(again.found(), 1);
}

/// What was left open is known by what was chosen, too.
TEST_F(Record, TellsDesignsSettingsRowsAndRequestsApart) {
  RunDatabase record(file());
  record.keep(key(0.1), evaluated(1.0));
  EvaluationKey setting = key(0.1), rows = key(0.1);
  setting.setting = "step 2e-05 s";
  rows.rows = "peaks of 16 windows";
  for (const EvaluationKey& other :
       {key(std::nextafter(0.1, 1.0)), setting, rows, key(0.1, Request::values),
        key(0.1, Request::values_and_gradients, "direct")}) {
    EXPECT_FALSE(record.find(other)) << other.setting << other.rows << other.method;
  }
  EXPECT_TRUE(record.find(key(0.1, Request::values_and_gradients, "adjoint")));
}

TEST_F(Record, KeepsFailuresAndWhatIsNoFiniteNumberAndGradientsOfNoRows) {
  RunDatabase record(file());
  StoredEvaluation failed, without_rows = evaluated(1.0);
  failed.failure = "at t = 0.1 s: Newton's method does not converge";
  without_rows.evaluation.constraints.resize(0);
  without_rows.evaluation.constraint_jacobian.resize(0, 2);
  record.keep(key(0.1), failed);
  record.keep(key(0.2), evaluated(std::numeric_limits<double>::quiet_NaN()));
  record.keep(key(0.3), evaluated(-std::numeric_limits<double>::infinity()));
  record.keep(key(0.4), without_rows);
  const auto found = record.find(key(0.1));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->failure, failed.failure);
  EXPECT_FALSE(found->evaluation.has_gradients());
  EXPECT_TRUE(std::isnan(record.find(key(0.2))->evaluation.objective));
  EXPECT_EQ(record.find(key(0.3))->evaluation.objective, -std::numeric_limits<double>::infinity());
  const Evaluation gradients = record.find(key(0.4))->evaluation;
  EXPECT_EQ(gradients.constraint_jacobian.rows(), 0);
  EXPECT_EQ(gradients.constraint_jacobian.cols(), 2);
}

TEST_F(Record, KeepsTheWayOfTheSearchInItsOrder) {
  EvaluationRecord record;
  record.x = Eigen::Vector2d(0.1, 0.2);
  record.constraints = Eigen::VectorXd::Constant(1, 1.0 / 3.0);
  record.purpose = Purpose::restoration;
  record.elements = 8;
  RunDatabase database(file());
  for (const int number : {2, 1}) {
    record.evaluation = number;
    record.failure = number == 2 ? "locks" : "";
    database.add(record);
  }
  Database written(file());
  Statement row(written,
                "SELECT constraints, purpose, elements, failure FROM history ORDER BY evaluation");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(vector_of(row.blob(0)), record.constraints);
  EXPECT_EQ(row.text(1), "restoration");
  EXPECT_EQ(row.integer(2), 8);
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.text(3), "locks");
  EXPECT_FALSE(row.step());
}

TEST_F(Record, RefusesFilesOfAnotherKindOrVersion) {
  record().describe("command", "optimize");
  execute("PRAGMA user_version = 7");
  EXPECT_THAT(thrown<DatabaseError>([&] { record(); }), HasSubstr("another version"));
  std::ofstream(file()) << std::string(5000, 'x');
  EXPECT_THROW(record(), DatabaseError);
}

TEST_F(Record, NamesTheRowThatWasChanged) {
  for (const std::string change :
       {"objective = 0.9 * objective", "constraints = zeroblob(7)", "objective_gradient = x'00'",
        "constraint_gradients = NULL", "failure = 'locks'", "reason = 'none'", "objective = NULL",
        "design = zeroblob(16)", "asked_method = 'adjoint'", "method = 'direct'", "seconds = 9",
        "request = 'values'"}) {
    std::filesystem::remove(file());
    for (const double x : {0.1, 0.2}) record().keep(key(x), evaluated(x));
    EXPECT_EQ(refusal(), "");
    execute("UPDATE evaluations SET " + change + " WHERE id = 2");
    EXPECT_THAT(refusal(), HasSubstr("row 2 of the table evaluations")) << change;
  }
}

TEST_F(Record, NamesWhatIsSaidOfTheRunAndWasChanged) {
  record().describe("design", "{}");
  record().keep_part("run 1", "content");
  for (const auto& [change, part] :
       {std::pair{"UPDATE parts SET content = x'00'", "row run 1 of the table parts"},
        {"UPDATE run SET value = '{'", "row design of the table run"},
        {"DELETE FROM run; DROP TABLE parts", "parts"}}) {
    execute(change);
    EXPECT_THAT(refusal(), HasSubstr(part));
  }
}

/// Bytes that flip, and ends that are lost: either it is refused, or what it gives is what was kept.
TEST_F(Record, GivesNoOtherNumbersWhenItIsDamaged) {
  record().describe("design", "{}");
  for (int i = 0; i < 20; ++i) record().keep(key(i), evaluated(1.0 + i));
  record().keep_part("run 1", std::string(300, 'x'));
  const std::string whole = read_text(file());
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::string damaged = whole;
    const std::size_t place =
        std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    if (round % 10 == 0) {
      damaged.resize(place);
    } else {
      damaged[place] = static_cast<char>(damaged[place] ^ (1 << round % 8));
    }
    std::ofstream(file(), std::ios::binary) << damaged;
    if (!refusal().empty()) {
      ++refused;
      continue;
    }
    RunDatabase record(file());
    for (int i = 0; i < 20; ++i) {
      const auto found = record.find(key(i));
      EXPECT_EQ(found ? found->evaluation.objective : 1.0 + i, 1.0 + i) << round;
    }
    EXPECT_EQ(record.description("design").value_or("{}"), "{}");
    EXPECT_EQ(record.find_part("run 1").value_or(std::string(300, 'x')), std::string(300, 'x'));
  }
  EXPECT_GT(refused, 50);
}

TEST_F(Record, KnowsWhatIsOlderAndRefusesWhatIsNotComputedAgain) {
  RunDatabase(file()).keep(key(0.1), evaluated(1.0));
  RunDatabase record(file());
  record.keep(key(0.2), evaluated(2.0));
  StoredEvaluation again = *record.find(key(0.1));
  EXPECT_EQ(again.older_row, 1);
  EXPECT_EQ(record.find(key(0.2))->older_row, 0);
  again.evaluation.objective += 1e-9;
  EXPECT_NO_THROW(record.confirm(key(0.1), again));
  std::vector<StoredEvaluation> others(4, again);
  others[0].evaluation.objective = 0.9;
  others[1].evaluation.constraints(0) *= 1.001;
  others[2].evaluation.objective_gradient(1) *= 0.9;
  others[3].failure = "locks";
  for (const StoredEvaluation& other : others) {
    EXPECT_THROW(record.confirm(key(0.1), other), InputError);
  }
}

/// A process that is killed at any instant loses nothing that keep() has returned from.
TEST_F(Record, HasAllThatWasKeptBeforeAKill) {
  std::mt19937 random(1);
  int begin = 0;
  for (int round = 0; round < 10; ++round) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t writer = ::fork();
    if (writer == 0) {
      RunDatabase record(file());
      for (int i = begin;; ++i) {
        record.keep(key(i), evaluated(i));
        if (::write(ends[1], &i, sizeof i) != sizeof i) ::_exit(1);
      }
    }
    ::usleep(std::uniform_int_distribution<useconds_t>(1000, 40000)(random));
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    ::close(ends[1]);
    int last = begin - 1;
    for (int i = 0; ::read(ends[0], &i, sizeof i) == sizeof i;) last = i;
    ::close(ends[0]);
    RunDatabase record(file());
    EXPECT_GE(record.evaluations(), last + 1);
    for (int i = 0; i <= last; ++i) {
      const auto found = record.find(key(i));
      ASSERT_TRUE(found) << i;
      ASSERT_EQ(found->evaluation.objective, i);
    }
    begin = last + 1;
  }
  EXPECT_GT(begin, 0);
}

}  // namespace
}  // namespace pleuel::test::run_database_test
