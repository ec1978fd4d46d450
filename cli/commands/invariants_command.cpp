#include "cli/commands/commands.hpp"
#include "core/model/divided_beams.hpp"
#include "core/model/motion_plane.hpp"
#include "core/response/analysis.hpp"
#include "core/response/body_export.hpp"
#include "core/scene/body_constants.hpp"

namespace pleuel {

namespace {

std::vector<std::string> si_units(const ProblemFile& problem) {
  std::vector<std::string> units;
  for (const DesignVariable& variable : problem.variables) {
    units.emplace_back(variable.quantity.unit);
  }
  return units;
}

std::vector<std::string> chosen_bodies(const Arguments& arguments, const Model& model) {
  if (arguments.body) return {model.body(*arguments.body).name};
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) {
    if (body.is_elastic) names.push_back(body.name);
  }
  if (names.empty()) throw InputError("no body is elastic: there are no invariants to write");
  return names;
}

/// What the files will not know.
std::vector<std::string> export_warnings(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> start(x.begin(), x.end());
  if (!decide_motion_plane(problem.scene, problem.effects.spatial_motion, start).plane) return {};
  return {
      "the mechanism moves in a plane: the files know nothing of what bends or buckles across it. "
      "--set '/effects/spatial_motion=on' exports that, too."};
}

std::vector<InvariantsFile> export_bodies(const Arguments& arguments, const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> start(x.begin(), x.end());
  const Model model = build_model(without_divisions(problem.scene), problem.effects, start, start,
                                  problem.sensitivity.invariants);
  std::vector<InvariantsFile> files;
  for (const std::string& name : chosen_bodies(arguments, model)) {
    files.push_back(export_body(problem, model, name, si_units(problem)));
  }
  return files;
}

/// In a folder of their own, where no name of a body can be that of another result. Names of bodies
/// may hold what names of files cannot.
std::string constants_file_name(const std::string& body) {
  std::string name = body + ".json";
  std::ranges::replace(name, '/', '_');
  return name;
}

Json file_document(const InvariantsFile& file, const fs::path& path) {
  return {{"name", file.body},
          {"file", path.string()},
          {"coordinates", file.coordinates.size()},
          {"places", list_of(file.constants.places, &BodyPlace::name)},
          {"stress_points", file.constants.stress ? file.constants.stress->points.size() : 0},
          {"stiffening", file.constants.stretching.has_value()},
          {"variables", list_of(file.design, &ConstantsDerivative::variable)}};
}

Outcome report(const ProblemFile& problem, const std::vector<InvariantsFile>& files,
               const std::vector<fs::path>& paths) {
  const std::vector<std::string> warnings = export_warnings(problem);
  Outcome outcome{ExitCode::done, {{"bodies", Json::array()}, {"warnings", warnings}}, ""};
  Table table(
      {left_aligned("body"), "coordinates", "places", "variables", left_aligned("written to")});
  for (std::size_t i = 0; i < files.size(); ++i) {
    outcome.document["bodies"].push_back(file_document(files[i], paths[i]));
    table.add_row({files[i].body, std::to_string(files[i].coordinates.size()),
                   std::to_string(files[i].constants.places.size()),
                   std::to_string(files[i].design.size()), paths[i].string()});
  }
  outcome.text = table.text() + warnings_text(warnings);
  return outcome;
}

Outcome write_one(const fs::path& path, const ProblemFile& problem,
                  const std::vector<InvariantsFile>& files) {
  if (files.size() != 1) {
    throw InputError(
        fmt::format("-o {}: is one file, but {} bodies are elastic; choose one with "
                    "--body, or a folder",
                    path.string(), files.size()));
  }
  Outcome outcome = report(problem, files, {path});
  write_file({path, &outcome.unwritten}, write_invariants(files.front()));
  return outcome;
}

}  // namespace

Outcome run_invariants(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  if (arguments.output && arguments.output->extension() == ".json") {
    require_free(*arguments.output, arguments);
    return write_one(*arguments.output, input.problem, export_bodies(arguments, input.problem));
  }
  RunRecord record(arguments, input, Json::object());
  record.begin_phase("export");
  const std::vector<InvariantsFile> files = export_bodies(arguments, input.problem);
  record.begin_phase("write");
  std::vector<fs::path> paths;
  for (const InvariantsFile& file : files) {
    const ResultFile written = record.result(fs::path("bodies") / constants_file_name(file.body));
    const fs::path& path = written.path;
    if (std::ranges::find(paths, path) != paths.end()) {
      throw InputError(fmt::format("two bodies would be written to {}: use --body", path.string()));
    }
    paths.push_back(path);
    write_file(written, write_invariants(file));
  }
  Outcome outcome = report(input.problem, files, paths);
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
