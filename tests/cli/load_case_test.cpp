#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::load_case_test {
namespace {

using LoadCases = InProgramFolder;

TEST_F(LoadCases, GoThroughSimulateOneAfterTheOther) {
  const nlohmann::json cases =
      exits(0, folder_.run({"simulate", problem("two_loads"), "--json"})).document().at("cases");
  ASSERT_EQ(cases.size(), 2u);
  const auto torque = [&](const char* name) {
    return cases.at(name).at("responses").at("torque").at("value").get<double>();
  };
  EXPECT_NE(torque("fast"), torque("heavy"));
  // A limit that names a case is that of this case only.
  EXPECT_FALSE(cases.at("fast").at("constraints").contains("rod_strength"));
  EXPECT_TRUE(cases.at("heavy").at("constraints").contains("rod_strength"));
}

TEST_F(LoadCases, AreTakenAloneByTheirNames) {
  const ProgramRun run =
      exits(0, folder_.run({"simulate", problem("two_loads"), "--case", "heavy", "-o", "one"}));
  EXPECT_THAT(run.out, HasSubstr("two loads [heavy]"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "one" / "trajectory.csv"));
  const ProgramRun unknown =
      exits(2, folder_.run({"simulate", problem("two_loads"), "--case", "hevy"}));
  EXPECT_THAT(unknown.err, HasSubstr("did you mean \"heavy\"?"));
}

TEST_F(LoadCases, HaveToBeNamedWhereACommandTakesOne) {
  for (const std::string command : {"prices", "stability"}) {
    const ProgramRun run = folder_.run({command, problem("two_loads")});
    EXPECT_EQ(run.exit_code, 2) << command;
    EXPECT_THAT(unwrapped(run.err), HasSubstr("--case")) << command;
  }
  EXPECT_FALSE(
      exits(0, folder_.run({"stability", problem("two_loads"), "--case", "fast", "--json"}))
          .document()
          .at("formulations")
          .empty());
}

/// The shipped problem with a number of both cases, and a limit on it.
std::string with_spread(const ProgramFolder& folder) {
  nlohmann::ordered_json document = nlohmann::ordered_json::parse(read_file(problem("two_loads")));
  document["responses"]["spread"] = {{"type", "expression"},
                                     {"value", "rod_bow[fast] - 2*rod_bow[heavy]"}};
  document["constraints"]["evenness"] = {{"response", "spread"}, {"upper", "0.05 mm"}};
  const std::filesystem::path file = folder.path() / "spread.json";
  std::ofstream(file) << document.dump(2);
  return file.string();
}

TEST_F(LoadCases, MakeNumbersTogether) {
  const std::string file = with_spread(folder_);
  for (const std::string command : {"simulate", "gradient"}) {
    const nlohmann::json document = exits(0, folder_.run({command, file, "--json"})).document();
    const auto entry = [&](const char* name) {
      return document.at("cases").at(name).at("responses").at("rod_bow");
    };
    const nlohmann::json spread = document.at("over_cases").at("responses").at("spread");
    const auto of_both = [&](const auto& number) {
      return number(entry("fast")) - 2.0 * number(entry("heavy"));
    };
    EXPECT_DOUBLE_EQ(spread.at("value"), of_both([](const nlohmann::json& one) {
                       return one.at("value").template get<double>();
                     }));
    EXPECT_TRUE(document.at("over_cases").at("constraints").contains("evenness"));
    if (command == "simulate") continue;
    for (const auto& [method, gradient] : spread.at("gradients").items()) {
      EXPECT_DOUBLE_EQ(
          gradient.at("rod_diameter"), of_both([&](const nlohmann::json& one) {
            return one.at("gradients").at(method).at("rod_diameter").template get<double>();
          }));
    }
  }
}

/// What both cases share cancels in a difference: its deviation is that of the difference of slopes.
TEST_F(LoadCases, ShareTheirUncertainParameters) {
  const nlohmann::json document =
      exits(0, folder_.run(
                   {"uncertainty", with_spread(folder_), "--json", "--set",
                    R"(/uncertainty={"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}})"}))
          .document();
  const auto deviation = [](const nlohmann::json& of) {
    return of.at("responses").at("rod_bow").at("deviation").get<double>();
  };
  const double fast = deviation(document.at("cases").at("fast"));
  const double heavy = deviation(document.at("cases").at("heavy"));
  const nlohmann::json spread = document.at("over_cases").at("responses").at("spread");
  EXPECT_NEAR(spread.at("deviation").get<double>(), fast - 2.0 * heavy, 1e-9 * fast);
  EXPECT_NEAR(spread.at("shares").at("rod_diameter").get<double>(), 1.0, 1e-12);
}

TEST_F(LoadCases, TellADesignThatBreaksALimitOnSeveral) {
  const std::string file = with_spread(folder_);
  const auto run_with = [&](const std::string& limit) {
    return folder_.run({"simulate", file, "--no-report", "--set", "rod_diameter=20 mm", "--set",
                        "/constraints/evenness/upper=" + limit});
  };
  EXPECT_THAT(run_with("-1 m").out, HasSubstr("BROKEN"));
  EXPECT_EQ(run_with("-1 m").exit_code, 4);
  EXPECT_THAT(run_with("1 m").out, Not(HasSubstr("made from several cases is broken")));
}

TEST_F(LoadCases, TakenAloneSayWhichLimitsTheyLeaveOut) {
  const std::string file = with_spread(folder_);
  const ProgramRun alone = folder_.run({"simulate", file, "--no-report", "--case", "heavy"});
  EXPECT_THAT(alone.out,
              HasSubstr("Not looked at, as it takes several cases: the limit evenness."));
  const ProgramRun all = folder_.run({"simulate", file, "--no-report"});
  EXPECT_THAT(all.out, Not(HasSubstr("Not looked at")));
}

/// What is found in the mechanism, after the file has been read: file, place and case.
TEST_F(LoadCases, AreNamedWhereOneOfThemCannotBe) {
  const auto complaint_with = [&](const std::string& place, const std::string& value) {
    nlohmann::ordered_json document =
        nlohmann::ordered_json::parse(read_file(problem("two_loads")));
    document[nlohmann::ordered_json::json_pointer(place)] = nlohmann::ordered_json::parse(value);
    const std::filesystem::path file = folder_.path() / "two.json";
    std::ofstream(file) << document.dump(2);
    return folder_.run({"simulate", file.string(), "--no-report"}).err;
  };
  // The frame of the rod holds its ends.
  EXPECT_THAT(complaint_with(
                  "/scene/bodies/rod/initial_deflections",
                  R"([{"at": ["120 mm", 0, 0], "direction": [0, 1, 0], "displacement": "1 mm"}])"),
              HasSubstr("two.json: in the case \"fast\": /scene/bodies/rod/initial_deflections/0"));
  // Its drive begins from rest, which no period ends with.
  EXPECT_THAT(complaint_with("/cases/heavy/~1simulation~1initial_state",
                             R"({"type": "periodic", "period": "100 ms"})"),
              HasSubstr("two.json: in the case \"heavy\": /simulation/initial_state: "));
}

TEST_F(LoadCases, AreLimitedTogether) {
  const ProgramRun run = exits(0, folder_.run({"optimize", with_spread(folder_), "-o", "run"}));
  EXPECT_THAT(run.out, HasSubstr("several"));
  const nlohmann::json result = folder_.result("run");
  const nlohmann::json limit = result.at("constraints").at("evenness");
  EXPECT_LE(limit.at("value"), 0.05e-3 * (1.0 + 1e-6));
  const nlohmann::json& responses = result.at("responses");
  EXPECT_NEAR(responses.at("spread").at("value").get<double>(),
              responses.at("rod_bow [fast]").at("value").get<double>() -
                  2.0 * responses.at("rod_bow [heavy]").at("value").get<double>(),
              1e-12);
  const auto bound = [&](const char* name) {
    return responses.at(name).at("error").at("total").get<double>();
  };
  // Errors of two cases add up; that of the sum is found from the same runs, to the safety in it.
  EXPECT_NEAR(bound("spread") / (bound("rod_bow [fast]") + 2.0 * bound("rod_bow [heavy]")), 1.0,
              0.5);
  EXPECT_THAT(read_file(folder_.path() / "run" / "history.csv"), HasSubstr("constraint:evenness"));
  const ProgramRun again = folder_.run({"optimize", with_spread(folder_), "-o", "run", "--resume"});
  EXPECT_THAT(again.out, HasSubstr("evaluations were known"));
}

/// The masses are the same in both and nothing has a price: what the verdict speaks of is shown.
TEST_F(LoadCases, ShowTheOneWhoseLimitCannotBeKept) {
  const ProgramRun run = exits(
      4, folder_.run({"optimize", problem("two_loads"), "-o", "run", "--no-report", "--set",
                      "/constraints/rod_strength/upper=1 kPa", "--set", "/simulation/step=0.4 ms",
                      "--set", "/optimizer={\"max_iterations\": 3}"}));
  const nlohmann::json result = folder_.result("run");
  EXPECT_THAT(result.at("message").get<std::string>(), HasSubstr("rod_strength [heavy]"));
  EXPECT_EQ(result.at("cases").at("shown"), "heavy");
}

TEST_F(LoadCases, SayWhichOfThemDecidesALimit) {
  const ProgramRun run = exits(0, folder_.run({"optimize", problem("two_loads"), "-o", "run"}));
  const nlohmann::json result = folder_.result("run");
  EXPECT_EQ(result.at("constraints").at("crank_strength [heavy]").at("decides"), true);
  EXPECT_EQ(result.at("constraints").at("crank_strength [fast]").at("decides"), false);
  EXPECT_EQ(result.at("constraints").at("rod_stiffness [fast]").at("case"), "fast");
  EXPECT_EQ(result.at("cases").at("shown"), "heavy");  // its limit costs most
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "run" / "trajectory-optimum-fast.csv"));
  const ProgramRun again = folder_.run({"optimize", problem("two_loads"), "-o", "run", "--resume"});
  EXPECT_THAT(again.out, HasSubstr("evaluations were known"));
  EXPECT_EQ(folder_.result("run").at("variables"), result.at("variables"));
  const ProgramRun motion = exits(0, folder_.run({"export", "run", "--vtk"}));
  EXPECT_THAT(unwrapped(motion.out), HasSubstr("instants of the case \"heavy\" written to"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "run" / "vtk" / "optimum-heavy.pvd"));
  const ProgramRun drawn = exits(0, folder_.run({"plot", "run", "torque"}));
}

/// A cantilever that a force bends at once, in two cases.
class BentCantilever : public testing::Test {
 protected:
  BentCantilever() {
    document_ = nlohmann::ordered_json::parse(R"json({
      "scene": {
        "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": ["300 mm", 0, 0], "material": "steel",
                           "section": {"type": "rectangle", "width": {"variable": "width"},
                                       "height": "= share*(1 mm)"},
                           "elements": 2, "damping": {"stiffness": "0.1 ms"}}},
        "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
        "loads": {"weight": {"type": "force", "body": "bar", "at": ["300 mm", 0, 0],
                             "direction": [0, -1, 0], "value": "200 N"}}},
      "simulation": {"end_time": "1 ms", "step": "0.1 ms", "initial_state": "quasi-static",
                     "resolution_check": false},
      "variables": {"width": {"start": "20 mm", "lower": "4 mm", "upper": "40 mm"},
                    "share": {"start": 28, "lower": 10, "upper": 60}},
      "responses": {"mass": {"type": "mass"},
                    "sag": {"type": "deflection", "body": "bar", "at": 1, "over_time": "max-abs"}},
      "objective": {"minimize": "mass"},
      "constraints": {"stiffness": {"response": "sag", "upper": "2 mm"}},
      "cases": {"down": {}, "other": {}}
    })json");
  }

  ProgramRun run(const std::vector<std::string>& words) const {
    std::ofstream(folder_.path() / "bar.json") << document_.dump(2);
    return folder_.run(words);
  }

  void write_table(const std::string& force) const {
    std::ofstream(folder_.path() / "table.csv")
        << "time [s],force [N]\n0," << force << "\n1," << force << "\n";
  }

  nlohmann::ordered_json document_;
  const ProgramFolder folder_;
};

TEST_F(BentCantilever, SaysWhatHasNoNumberOverItsCases) {
  document_["cases"]["other"]["/scene/loads/weight/value"] = "0 N";
  document_["responses"]["ratio"] = {{"type", "expression"}, {"value", "sag[down]/sag[other]"}};
  const nlohmann::json ratio = exits(3, run({"simulate", "bar.json", "--json"}))
                                   .document()
                                   .at("over_cases")
                                   .at("responses")
                                   .at("ratio");
  EXPECT_TRUE(ratio.at("value").is_null());
  EXPECT_THAT(ratio.at("error").get<std::string>(), HasSubstr("has no finite value there"));
  EXPECT_EQ(run({"gradient", "bar.json", "--json"}).exit_code, 3);
  EXPECT_THAT(unwrapped(run({"simulate", "bar.json"}).out), HasSubstr("has no finite value there"));
}

TEST_F(BentCantilever, KeepsTheOtherCasesWhereOneCannotBeSimulated) {
  // Far above the critical load of the column, about 1 MN.
  document_["cases"]["other"] = {{"/scene/loads/weight/direction", {-1, 0, 0}},
                                 {"/scene/loads/weight/value", "50 MN"}};
  const ProgramRun simulated = exits(3, run({"simulate", "bar.json", "--json"}));
  const nlohmann::json cases = simulated.document().at("cases");
  EXPECT_GT(cases.at("down").at("responses").at("sag").at("value"), 0.0);
  EXPECT_FALSE(cases.at("other").at("error").get<std::string>().empty());
  EXPECT_THAT(unwrapped(run({"simulate", "bar.json"}).out),
              HasSubstr("The case \"other\" cannot be simulated: "));
}

TEST_F(BentCantilever, IsAnotherOneWithAnotherFileOfACase) {
  write_table("100");
  document_["cases"]["other"]["/scene/loads/weight/value"] = {
      {"type", "table"}, {"file", "table.csv"}, {"columns", {"time", "force"}}};
  const std::vector<std::string> words = {"optimize", "bar.json", "-o", "run", "--resume"};
  ASSERT_EQ(run(words).exit_code, 0);
  EXPECT_EQ(run(words).exit_code, 0);
  write_table("150");
  EXPECT_THAT(exits(2, run(words)).err, HasSubstr("another file that the problem names"));
}

TEST_F(BentCantilever, IsADesignWithAVariableWithoutUnit) {
  ASSERT_EQ(run({"optimize", "bar.json", "-o", "run"}).exit_code, 0);
  const ProgramRun again = exits(0, run({"simulate", "bar.json", "--design", "run", "--json"}));
  const nlohmann::json best = folder_.result("run");
  EXPECT_EQ(again.document().at("cases").at("down").at("variables").at("share").at("value"),
            best.at("variables").at("share").at("value"));
}

}  // namespace
}  // namespace pleuel::test::load_case_test
