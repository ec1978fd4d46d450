#include <cstdlib>

#include <sys/wait.h>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

/// The check for instructions that the program was built for, before anything else runs.
namespace pleuel::test::processor_test {
namespace {

ProgramRun run_without(const std::string& instructions) {
  const ProgramFolder folder;
  const std::string out = (folder.path() / "out").string(), err = (folder.path() / "err").string();
  const int status = std::system(
      fmt::format("LACKING='{}' '{}' >'{}' 2>'{}'", instructions, PLEUEL_OLD_PROCESSOR, out, err)
          .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

TEST(ProcessorCheck, LetsTheProgramRunWhereNothingIsLacking) {
  const ProgramRun run = run_without("3DNow!");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "runs\n");
  EXPECT_EQ(run.err, "");
}

TEST(ProcessorCheck, NamesWhatIsLackingAndWhatToDo) {
  const std::pair<const char*, const char*> all[] = {
      {"sse4.2", "SSE4.2"}, {"avx", "AVX"},   {"avx2", "AVX2"},      {"fma", "FMA"},
      {"bmi", "BMI"},       {"bmi2", "BMI2"}, {"avx512f", "AVX-512"}};
  for (const auto& [instructions, name] : all) {
    const ProgramRun run = run_without(instructions);
    EXPECT_EQ(run.exit_code, 1) << name;
    EXPECT_EQ(run.out, "") << name;
    EXPECT_THAT(run.err, HasSubstr(fmt::format("this one lacks {}. Build it here: ", name)));
    EXPECT_THAT(run.err, HasSubstr("-DPLEUEL_NATIVE=OFF\n"));
  }
}

}  // namespace
}  // namespace pleuel::test::processor_test
