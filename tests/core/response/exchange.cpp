#include "tests/core/response/exchange.hpp"

#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/body_export.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

namespace {

constexpr const char* responses = R"({
  "mass": {"type": "mass"},
  "rod_mass": {"type": "mass", "body": "rod"},
  "rod_frequency": {"type": "frequency", "body": "rod", "mode": 2},
  "crank_stress": {"type": "stress", "body": "crank", "over_time": "max"},
  "rod_stress": {"type": "stress", "body": "rod", "over_time": "max"},
  "rod_pull": {"type": "stress", "body": "rod", "part": "normal", "over_time": "max"},
  "rod_use": {"type": "stress", "body": "rod", "part": "utilization", "over_time": "max"},
  "mean_stress": {"type": "stress", "body": "rod", "over_time": "mean"},
  "bow": {"type": "deflection", "body": "rod", "at": 0.5, "over_time": "max-abs"},
  "bow_rms": {"type": "deflection", "body": "rod", "at": 0.4, "over_time": "rms"},
  "sag": {"type": "deflection", "body": "rod", "at": 0.4, "against": "chord", "over_time": "rms"},
  "lag": {"type": "deflection", "body": "rod", "at": 0.5, "against": "rigid-mechanism",
          "direction": "y", "over_time": "max-abs"},
  "place": {"type": "position", "body": "rod", "at": 0.5, "direction": "y", "over_time": "rms"},
  "speed": {"type": "velocity", "body": "rod", "at": 0.4, "direction": "magnitude", "over_time": "rms"},
  "jerk": {"type": "acceleration", "body": "rod", "at": 0.5, "direction": "x", "over_time": "mean"},
  "energy": {"type": "elastic-energy", "body": "rod", "over_time": "rms"},
  "torque": {"type": "drive-torque", "joint": "bearing", "over_time": "rms"},
  "reaction": {"type": "reaction-force", "joint": "slider_pin", "direction": "magnitude", "over_time": "rms"}
})";

}  // namespace

Json slider_crank() {
  std::ifstream stream(source_folder() + "/problems/slider_crank.json");
  Json document = Json::parse(stream);
  document["simulation"]["end_time"] = 8e-3;
  document["simulation"]["step"] = 1e-4;
  document["simulation"]["newton_tolerance"] = 1e-13;
  document["scene"]["joints"]["bearing"]["drive"]["ramp"] = 8e-3;
  document["scene"]["materials"]["steel"]["strength"] = "355 MPa";
  document["scene"]["gravity"] = {0, -9.81, 0};
  document["scene"]["loads"]["tug"] = {{"type", "force"},
                                       {"body", "rod"},
                                       {"at", {0.2, 0, 0}},
                                       {"direction", {0, 1, 0}},
                                       {"value", -50}};
  document["responses"] = Json::parse(responses);
  for (const char* key :
       {"constraints", "pareto", "accuracy", "uncertainty", "optimizer", "$schema"}) {
    document.erase(key);
  }
  document["objective"] = {{"minimize", "mass"}};
  return document;
}

Differences compare(const ProblemFile& original, const ProblemFile& imported) {
  const Eigen::VectorXd x = start_design(original);
  auto a = analyze(original, x), b = analyze(imported, start_design(imported));
  Differences differences;
  differences.values =
      (values_of(*b) - values_of(*a)).cwiseQuotient(values_of(*a)).cwiseAbs().maxCoeff();
  const Eigen::MatrixXd expected = gradients(original, x, *a, GradientMethod::direct);
  const auto distance = [&](GradientMethod method) {
    const Eigen::MatrixXd found = gradients(imported, x, *b, method);
    double largest = 0.0;
    for (Eigen::Index i = 0; i < expected.rows(); ++i) {
      const double size = expected.row(i).cwiseAbs().maxCoeff();
      const double error = (found.row(i) - expected.row(i)).cwiseAbs().maxCoeff() / size;
      EXPECT_LE(error, 1e-6) << original.responses[i].name;
      largest = std::max(largest, error);
    }
    return largest;
  };
  differences.direct = distance(GradientMethod::direct);
  differences.adjoint = distance(GradientMethod::adjoint);
  return differences;
}

InvariantsFile exported(const ProblemFile& problem, const std::string& body) {
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> start(x.begin(), x.end());
  const Model model = build_model(problem.scene, problem.effects, start, start);
  std::vector<std::string> units;
  for (const DesignVariable& variable : problem.variables) {
    units.emplace_back(variable.start > 1e3 ? "Pa" : "m");
  }
  return export_body(problem, model, body, units);
}

std::string place_at(const InvariantsFile& file, double share) {
  for (const BodyPlace& place : file.constants.places) {
    if (std::abs(place.position.x() - 0.18 * share) < 1e-9) return place.name;
  }
  return "";
}

Json with_file(Json document, const InvariantsFile& file) {
  const bool is_in_space = document.contains(Json::json_pointer("/effects/spatial_motion"));
  if (!is_in_space && document["responses"].contains("rod_frequency")) {
    document["responses"]["rod_frequency"]["mode"] = 1;
  }
  const Json rod = document["scene"]["bodies"]["rod"];
  document["scene"]["bodies"]["rod"] = {
      {"type", "invariants"}, {"file", "rod.json"}, {"from", rod["from"]}, {"to", rod["to"]}};
  for (auto& [name, response] : document["responses"].items()) {
    if (response.contains("segment")) {
      response["at"] = fmt::format("segment {}", response["segment"].get<int>());
      response.erase("segment");
      continue;
    }
    if (!response.contains("at") || response["body"] != "rod") continue;
    // Responses at the same place share the name of the first.
    const double share = response["at"].get<double>();
    response["at"] = place_at(file, share);
    if (response.value("against", "") == "chord") {
      response["chord"] = {place_at(file, 0.0), place_at(file, 1.0)};
    }
  }
  return document;
}

ProblemFile Exchange::read(const std::string& name, const Json& document) const {
  std::ofstream(folder_.path() / name) << document;
  return read_problem(folder_.path() / name).complete();
}

std::string Exchange::complaint(const Json& document) const {
  return thrown<InputError>([&] {
    const ProblemFile problem = read("problem.json", document);
    analyze(problem, start_design(problem));
  });
}

void Exchange::write(const std::string& text) const {
  std::ofstream(path()) << text;
}

std::string Exchange::text() const {
  std::ifstream stream(path());
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Json Exchange::exchanged(const Json& document) const {
  const InvariantsFile file = exported(read("original.json", document), "rod");
  write(write_invariants(file));
  return with_file(document, file);
}

}  // namespace pleuel::test
