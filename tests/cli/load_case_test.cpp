#include "tests/cli/program.hpp"

namespace pleuel::test::load_case_test {
namespace {

class LoadCases : public InProgramFolder {
 protected:
  /// The shipped problem with a number of both cases, and a limit on it: "spread.json".
  LoadCases() {
    two_loads_ = nlohmann::ordered_json::parse(read_file(problem("two_loads")));
    nlohmann::ordered_json spread = two_loads_;
    spread["responses"]["spread"] = {{"type", "expression"},
                                     {"value", "rod_bow[fast] - 2*rod_bow[heavy]"}};
    spread["constraints"]["evenness"] = {{"response", "spread"}, {"upper", "0.05 mm"}};
    folder_.write("spread.json", spread);
  }

  nlohmann::ordered_json two_loads_;
};

TEST_F(LoadCases, GoThroughSimulateOneAfterTheOther) {
  const json cases = document("simulate $problems/two_loads.json").at("cases");
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_NE(number(cases, "fast/responses/torque/value"),
            number(cases, "heavy/responses/torque/value"));
  // A limit that names a case is that of this case only.
  EXPECT_FALSE(at(cases, "fast/constraints").contains("rod_strength"));
  EXPECT_TRUE(at(cases, "heavy/constraints").contains("rod_strength"));
}

TEST_F(LoadCases, AreTakenAloneByTheirNames) {
  EXPECT_THAT(run("simulate $problems/two_loads.json --case heavy -o one").out,
              HasSubstr("two loads [heavy]"));
  EXPECT_TRUE(folder_.has("one/trajectory.csv"));
  EXPECT_THAT(refusal("simulate $problems/two_loads.json --case hevy"),
              HasSubstr("did you mean \"heavy\"?"));
  // They have to be named where a command takes one.
  for (const std::string command : {"prices", "stability"}) {
    EXPECT_THAT(refusal(command + " $problems/two_loads.json"), HasSubstr("--case"));
  }
  const json alone = document("stability $problems/two_loads.json --case fast");
  EXPECT_FALSE(alone.at("formulations").empty());
}

TEST_F(LoadCases, MakeNumbersTogether) {
  for (const std::string command : {"simulate", "gradient"}) {
    const json found = document(command + " spread.json");
    const json spread = at(found, "over_cases/responses/spread");
    const auto of_both = [&](const std::string& path) {
      return number(found, "cases/fast/responses/rod_bow/" + path) -
             2.0 * number(found, "cases/heavy/responses/rod_bow/" + path);
    };
    EXPECT_DOUBLE_EQ(number(spread, "value"), of_both("value"));
    EXPECT_TRUE(at(found, "over_cases/constraints").contains("evenness"));
    if (command == "simulate") continue;
    for (const auto& [method, gradient] : spread.at("gradients").items()) {
      EXPECT_DOUBLE_EQ(number(gradient, "rod_diameter"),
                       of_both("gradients/" + method + "/rod_diameter"));
    }
  }
}

/// What both cases share cancels in a difference: its deviation is that of the difference of slopes.
TEST_F(LoadCases, ShareTheirUncertainParameters) {
  const json found = document(
      "uncertainty spread.json --set "
      R"('/uncertainty={"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}}')");
  const double fast = number(found, "cases/fast/responses/rod_bow/deviation");
  const double heavy = number(found, "cases/heavy/responses/rod_bow/deviation");
  const json spread = at(found, "over_cases/responses/spread");
  EXPECT_NEAR(number(spread, "deviation"), fast - 2.0 * heavy, 1e-9 * fast);
  EXPECT_NEAR(number(spread, "shares/rod_diameter"), 1.0, 1e-12);
}

TEST_F(LoadCases, TellADesignThatBreaksALimitOnSeveral) {
  const std::string line =
      "simulate spread.json --no-report --set 'rod_diameter=20 mm' "
      "--set '/constraints/evenness/upper=";
  EXPECT_THAT(run(line + "-1 m'", 4).out, HasSubstr("BROKEN"));
  EXPECT_THAT(run_line(folder_.path(), line + "1 m'").out,
              Not(HasSubstr("made from several cases is broken")));
}

TEST_F(LoadCases, TakenAloneSayWhichLimitsTheyLeaveOut) {
  EXPECT_THAT(run("simulate spread.json --no-report --case heavy").out,
              HasSubstr("Not looked at, as it takes several cases: the limit evenness."));
  EXPECT_THAT(run("simulate spread.json --no-report").out, Not(HasSubstr("Not looked at")));
}

/// What is found in the mechanism, after the file has been read: file, place and case.
TEST_F(LoadCases, AreNamedWhereOneOfThemCannotBe) {
  for (const auto& [place, value, expected] :
       {// The frame of the rod holds its ends.
        std::tuple{"/scene/bodies/rod/initial_deflections",
                   R"([{"at": ["120 mm", 0, 0], "direction": [0, 1, 0], "displacement": "1 mm"}])",
                   "\"fast\": /scene/bodies/rod/initial_deflections/0"},
        // Its drive begins from rest, which no period ends with.
        {"/cases/heavy/~1simulation~1initial_state", R"({"type": "periodic", "period": "100 ms"})",
         "\"heavy\": /simulation/initial_state: "}}) {
    nlohmann::ordered_json problem = two_loads_;
    problem[nlohmann::ordered_json::json_pointer(place)] = nlohmann::ordered_json::parse(value);
    folder_.write("two.json", problem);
    EXPECT_THAT(run_line(folder_.path(), "simulate two.json --no-report").err,
                HasSubstr(std::string("two.json: in the case ") + expected));
  }
}

TEST_F(LoadCases, AreLimitedTogether) {
  EXPECT_THAT(run("optimize spread.json -o run").out, HasSubstr("several"));
  EXPECT_LE(number(result(), "constraints/evenness/value"), 0.05e-3 * (1.0 + 1e-6));
  const json responses = result().at("responses");
  EXPECT_NEAR(
      number(responses, "spread/value"),
      number(responses, "rod_bow [fast]/value") - 2.0 * number(responses, "rod_bow [heavy]/value"),
      1e-12);
  // Errors of two cases add up; that of the sum is found from the same runs, to the safety in it.
  EXPECT_NEAR(number(responses, "spread/error/total") /
                  (number(responses, "rod_bow [fast]/error/total") +
                   2.0 * number(responses, "rod_bow [heavy]/error/total")),
              1.0, 0.5);
  EXPECT_THAT(folder_.text("run/history.csv"), HasSubstr("constraint:evenness"));
  EXPECT_THAT(run("optimize spread.json -o run --resume").out, HasSubstr("evaluations were known"));
}

/// The masses are the same in both and nothing has a price: what the verdict speaks of is shown.
TEST_F(LoadCases, ShowTheOneWhoseLimitCannotBeKept) {
  run("optimize $problems/two_loads.json -o run --no-report "
      "--set '/constraints/rod_strength/upper=1 kPa' --set '/simulation/step=0.4 ms' "
      "--set '/optimizer={\"max_iterations\": 3}'",
      4);
  EXPECT_THAT(result().at("message").get<std::string>(), HasSubstr("rod_strength [heavy]"));
  EXPECT_EQ(at(result(), "cases/shown"), "heavy");
}

TEST_F(LoadCases, SayWhichOfThemDecidesALimit) {
  run("optimize $problems/two_loads.json -o run");
  const json found = result();
  EXPECT_EQ(at(found, "constraints/crank_strength [heavy]/decides"), true);
  EXPECT_EQ(at(found, "constraints/crank_strength [fast]/decides"), false);
  EXPECT_EQ(at(found, "constraints/rod_stiffness [fast]/case"), "fast");
  EXPECT_EQ(at(found, "cases/shown"), "heavy");  // its limit costs most
  EXPECT_TRUE(folder_.has("run/trajectory-optimum-fast.csv"));
  EXPECT_THAT(run("optimize $problems/two_loads.json -o run --resume").out,
              HasSubstr("evaluations were known"));
  EXPECT_EQ(result().at("variables"), found.at("variables"));
  EXPECT_THAT(unwrapped(run("export run --vtk").out),
              HasSubstr("instants of the case \"heavy\" written to"));
  EXPECT_TRUE(folder_.has("run/vtk/optimum-heavy.pvd"));
  run("plot run torque");
}

/// A cantilever that a force bends at once, in two cases.
class BentCantilever : public InProgramFolder {
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

  std::string line(const std::string& command, const std::string& options = "") const {
    folder_.write("bar.json", document_);
    return command + " bar.json " + options;
  }

  nlohmann::ordered_json document_;
};

TEST_F(BentCantilever, SaysWhatHasNoNumberOverItsCases) {
  document_["cases"]["other"]["/scene/loads/weight/value"] = "0 N";
  document_["responses"]["ratio"] = {{"type", "expression"}, {"value", "sag[down]/sag[other]"}};
  const json ratio = at(document(line("simulate"), 3), "over_cases/responses/ratio");
  EXPECT_TRUE(ratio.at("value").is_null());
  EXPECT_THAT(ratio.at("error").get<std::string>(), HasSubstr("has no finite value there"));
  run(line("gradient", "--json"), 3);
  EXPECT_THAT(unwrapped(run(line("simulate"), 3).out), HasSubstr("has no finite value there"));
}

TEST_F(BentCantilever, KeepsTheOtherCasesWhereOneCannotBeSimulated) {
  // Far above the critical load of the column, about 1 MN.
  document_["cases"]["other"] = {{"/scene/loads/weight/direction", {-1, 0, 0}},
                                 {"/scene/loads/weight/value", "50 MN"}};
  const json cases = document(line("simulate"), 3).at("cases");
  EXPECT_GT(number(cases, "down/responses/sag/value"), 0.0);
  EXPECT_FALSE(at(cases, "other/error").get<std::string>().empty());
  EXPECT_THAT(unwrapped(run(line("simulate"), 3).out),
              HasSubstr("The case \"other\" cannot be simulated: "));
}

TEST_F(BentCantilever, IsAnotherOneWithAnotherFileOfACase) {
  const auto write_table = [&](const std::string& force) {
    folder_.write("table.csv", "time [s],force [N]\n0," + force + "\n1," + force + "\n");
  };
  write_table("100");
  document_["cases"]["other"]["/scene/loads/weight/value"] = {
      {"type", "table"}, {"file", "table.csv"}, {"columns", {"time", "force"}}};
  const std::string words = line("optimize", "-o run --resume");
  run(words);
  run(words);
  write_table("150");
  EXPECT_THAT(refusal(words), HasSubstr("another file that the problem names"));
}

TEST_F(BentCantilever, IsADesignWithAVariableWithoutUnit) {
  run(line("optimize", "-o run"));
  EXPECT_EQ(at(document(line("simulate", "--design run")), "cases/down/variables/share/value"),
            at(result(), "variables/share/value"));
}

}  // namespace
}  // namespace pleuel::test::load_case_test
