#include <numbers>

#include "cli/commands/commands.hpp"
#include "cli/files/output_file.hpp"
#include "reduction/reduce.hpp"

namespace pleuel {

namespace {

double hertz(double frequency) {
  return frequency / (2.0 * std::numbers::pi);
}

Json body_document(const ReducedBody& body, const ReductionModel& model, const fs::path& path) {
  const BodyConstants& constants = body.file.constants;
  Json document;
  document["file"] = path.string();
  document["nodes"] = model.mesh.size();
  document["elements"] = model.mesh.elements.size();
  document["mass"] = constants.mass;
  document["volume"] = body.volume;
  document["extent"] = {body.extent(0), body.extent(1), body.extent(2)};
  document["coordinates"] = body.file.coordinates;
  document["frequencies_with_held_interfaces"] =
      std::vector<double>(body.frequencies.begin(), body.frequencies.end());
  document["next_frequency"] = body.next_frequency;
  document["asymmetry"] = body.asymmetry;
  document["stress_points"] = constants.stress ? constants.stress->points.size() : 0;
  document["stiffening"] = constants.stretching.has_value();
  document["warnings"] = body.findings;
  return document;
}

std::string understood_text(const ReducedBody& body, const ReductionModel& model) {
  const BodyConstants& constants = body.file.constants;
  const Eigen::Vector3d centre = constants.first_moment / constants.mass;
  return fmt::format(
      "{}: {} nodes, {} elements; {:.4g} x {:.4g} x {:.4g} m, {:.6g} kg, {:.5g} kg/m³, centre of "
      "mass "
      "at ({:.4g}, {:.4g}, {:.4g}) m\n",
      body.file.body, model.mesh.size(), model.mesh.elements.size(), body.extent(0), body.extent(1),
      body.extent(2), constants.mass, constants.mass / body.volume, centre(0), centre(1),
      centre(2));
}

std::string modes_text(const ReducedBody& body) {
  Table table({left_aligned("mode with held interfaces"), "frequency [Hz]"});
  for (Eigen::Index i = 0; i < body.frequencies.size(); ++i) {
    table.add_row({std::to_string(i + 1), fmt::format("{:.1f}", hertz(body.frequencies(i)))});
  }
  if (body.next_frequency > 0.0) {
    table.add_row({"first that is left out", fmt::format("{:.1f}", hertz(body.next_frequency))});
  }
  return table.text();
}

std::string result_text(const ReducedBody& body, const ReductionModel& model,
                        const fs::path& path) {
  const BodyConstants& constants = body.file.constants;
  std::string text = wrapped(understood_text(body, model)) + modes_text(body);
  text += wrapped(fmt::format(
      "{} coordinates, {} places, {} stress points, geometric stiffening: {}; written to {}\n",
      body.file.coordinates.size(), constants.places.size(),
      constants.stress ? constants.stress->points.size() : 0,
      constants.stretching ? "yes" : "no, the file will not stiffen under tension", path.string()));
  if (model.plane) {
    text += wrapped(fmt::format("For motion in a plane: the mesh is symmetric about it to {:.1e}\n",
                                body.asymmetry));
  }
  for (const std::string& finding : body.findings) text += wrapped("WARNING: " + finding + "\n");
  return text;
}

}  // namespace

Outcome run_reduce(const Arguments& arguments) {
  const fs::path path = *arguments.output;
  require_free(path, arguments);
  const ReductionModel model = read_reduction_model(arguments.file.string());
  const ReducedBody body = reduce(model);
  Outcome outcome{ExitCode::done, body_document(body, model, path), result_text(body, model, path)};
  make_folder_of(path);
  write_file({path, &outcome.unwritten}, write_invariants(body.file));
  return outcome;
}

}  // namespace pleuel
